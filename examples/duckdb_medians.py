"""Medians over the records with DuckDB from Python, by the query of medians.sql.

    python examples/duckdb_medians.py outputs/sweep
"""

import sys
from pathlib import Path

import duckdb

QUERY = Path(__file__).with_name("medians.sql")


def medians(folder):
    """{(configuration, slenderness): median θ₁/α₁}; inf where the median wall collapsed."""
    with duckdb.connect() as connection:
        files = str(Path(folder) / "runs/*/*.parquet").replace("'", "''")
        connection.execute(f"CREATE VIEW runs AS FROM read_parquet('{files}')")
        rows = connection.execute(QUERY.read_text(encoding="utf-8")).fetchall()
    return {(configuration, slenderness): median for configuration, slenderness, median, *_ in rows}


if __name__ == "__main__":
    for case, median in medians(sys.argv[1]).items():
        print(*case, median)
