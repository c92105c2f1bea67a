-- Medians over the records of the reference façades, in DuckDB. A collapsed wall ranks above every rotation that was
-- reached; failed runs take no part and are counted.
--
--   duckdb -c "CREATE VIEW runs AS FROM 'outputs/sweep/runs/*/*.parquet'" -f examples/medians.sql
SELECT
    configuration,
    slenderness,
    median(CASE outcome WHEN 'stood' THEN theta1_max_over_alpha1 WHEN 'collapsed' THEN 'inf'::DOUBLE END) AS median,
    count(*) FILTER (outcome = 'collapsed') AS collapsed,
    count(*) FILTER (outcome = 'failed') AS failed
FROM runs
WHERE variant = 'base' AND parameter = 'stiffness' AND level = 'mu'
GROUP BY configuration, slenderness
ORDER BY configuration, slenderness;
