# %% [markdown]
# # A million walls, asked by DuckDB
#
# A wall a row, each under one record at one scale, in pieces that fit into memory; DuckDB asks the files in SQL.

# %%
import os
import tempfile
from pathlib import Path

import duckdb
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

import mrbd

WALLS = int(os.environ.get("MRBD_WALLS", "1000000"))
PIECE = min(WALLS, 100_000)
out = Path(tempfile.mkdtemp())
records = list(mrbd.records.generate())


def facades(count: int, random: np.random.Generator) -> pa.Table:
    """Façades of one or two bricks."""
    height_m = random.uniform(2.5, 4.5, count)
    return pa.table(
        {
            "thickness_m": random.choice([0.25, 0.38], count),
            "height_m": height_m,
            "crack_height_m": random.uniform(0.5, 0.75, count) * height_m,
            "length_m": np.ones(count),
            "density_kg_m3": np.full(count, 1800.0),
        }
    )


# %%
for piece in range(WALLS // PIECE):
    random = np.random.default_rng(piece)
    walls = facades(PIECE, random)
    shaken = [records[i] for i in random.integers(0, len(records), PIECE)]
    runs = mrbd.simulate_many(walls, shaken, scales=random.uniform(1.0, 8.0, PIECE), pairs="matched", tail_s=0.0)
    table = pa.table(runs).append_column("thickness_m", walls["thickness_m"])
    table = table.append_column("height_m", walls["height_m"])
    pq.write_table(table, out / f"piece-{piece:04}.parquet")

# %%
table = duckdb.sql(f"""
    SELECT thickness_m, floor(height_m / thickness_m / 4) * 4 AS slenderness_from, count(*) AS walls,
           avg(collapsed::INT) AS share_collapsed, median(theta1_max_over_alpha1) AS median_rotation
    FROM '{out}/*.parquet' WHERE outcome <> 'failed' GROUP BY ALL ORDER BY ALL
""")
assert table is not None
table.show()
