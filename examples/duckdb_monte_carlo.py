"""Medians over drawn façades and records with DuckDB from Python, by the query of monte_carlo.sql.

    python examples/duckdb_monte_carlo.py outputs/monte_carlo
"""

import sys
from pathlib import Path

import duckdb

QUERY = Path(__file__).with_name("monte_carlo.sql")


def medians(folder):
    """{configuration: median θ₁/α₁}; inf where the median wall collapsed."""
    with duckdb.connect() as connection:
        files = str(Path(folder) / "runs/*/*.parquet").replace("'", "''")
        connection.execute(f"CREATE VIEW runs AS FROM read_parquet('{files}')")
        rows = connection.execute(QUERY.read_text(encoding="utf-8")).fetchall()
    return {configuration: median for configuration, median, *_ in rows}


if __name__ == "__main__":
    for case, median in medians(sys.argv[1]).items():
        print(case, median)
