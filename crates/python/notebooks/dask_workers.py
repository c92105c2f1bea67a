# %% [markdown]
# # Façades over Dask workers
#
# Who outgrows one machine and has no Slurm: walls and records pickle, so every worker of a Dask cluster runs a piece. The
# cluster here is a local one; `Client("tcp://scheduler:8786")` is any other.

# %%
import numpy as np
import pyarrow as pa
from dask.distributed import Client, LocalCluster

import mrbd


def facades(count: int, seed: int) -> pa.Table:
    """Façades of one brick."""
    random = np.random.default_rng(seed)
    return pa.table(
        {
            "thickness_m": random.normal(0.25, 0.02, count),
            "height_m": random.normal(3.0, 0.3, count),
            "length_m": np.ones(count),
            "density_kg_m3": np.full(count, 1800.0),
        }
    )


def collapsed(seed: int, records: list[mrbd.Record], scale: float) -> list[bool]:
    """The outcomes of a piece; one thread, since every processor has a worker."""
    runs = mrbd.simulate_many(facades(50, seed), records, scales=scale, threads=1, progress=False)
    return [outcome == "collapsed" for outcome in runs["outcome"]]


# %%
if __name__ == "__main__":
    records = list(mrbd.records.generate())
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        pieces = [client.submit(collapsed, seed, records, 4.0) for seed in range(8)]
        outcomes = np.concatenate(client.gather(pieces))
    here = np.concatenate([collapsed(seed, records, 4.0) for seed in range(8)])
    assert np.array_equal(outcomes, here), "workers give the bits of this process"
    print(f"{outcomes.mean():.1%} of {len(outcomes)} runs collapsed")
