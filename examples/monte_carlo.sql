-- Quantiles over drawn façades and records, in DuckDB. A collapsed wall ranks above every rotation that was reached; failed
-- runs take no part and are counted.
--
--   duckdb -c "CREATE VIEW runs AS FROM 'outputs/monte_carlo/runs/*/*.parquet'" -f examples/monte_carlo.sql
SELECT
    configuration,
    median(rotation) AS median,
    quantile_cont(rotation, 0.84) AS q84,
    avg((outcome = 'collapsed')::INT) FILTER (outcome <> 'failed') AS share_collapsed,
    count(*) FILTER (outcome = 'failed') AS failed
FROM (
    SELECT *, CASE outcome WHEN 'stood' THEN theta1_max_over_alpha1 WHEN 'collapsed' THEN 'inf'::DOUBLE END AS rotation
    FROM runs
    WHERE variant = 'base'
)
GROUP BY configuration
ORDER BY configuration;
