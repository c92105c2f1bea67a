# %% [markdown]
# # Fragility of a class of façades, in twenty lines
#
# Façades of one storey, as they vary from house to house: thickness, height and floor are drawn, each is shaken by seven
# records at growing peak ground velocities, and a log-normal curve is fitted to the collapses.

# %%
import os
from pathlib import Path

import numpy as np
import pyarrow as pa

import mrbd

FACADES = int(os.environ.get("MRBD_FACADES", "400"))
ROOT = Path(os.environ.get("MRBD_REPOSITORY", "../../.."))
random = np.random.default_rng(1)

height_m = random.normal(3.2, 0.3, FACADES)
facades = pa.table(
    {
        "thickness_m": random.normal(0.28, 0.03, FACADES),
        "height_m": height_m,
        "crack_height_m": 0.6 * height_m,
        "length_m": np.ones(FACADES),
        "density_kg_m3": np.full(FACADES, 1800.0),
        "diaphragm_mass_kg": random.lognormal(np.log(200.0), 0.3, FACADES),
        "stiffness_n_per_m": random.lognormal(np.log(20e3), 0.5, FACADES),
    }
)
suite = mrbd.records.suite(ROOT / "inputs/records/emilia7/suite.toml")
scales = np.geomspace(0.4, 5.0, 8)
runs = mrbd.simulate_many(facades, suite, scales=scales)

# %% [markdown]
# The intensity of each run: the peak ground velocity of its record, scaled.

# %%
pgv_m_s = {record.name: record.measures()["pgv_m_s"] for record in suite}
intensity = [pgv_m_s[name] * scale for name, scale in zip(runs["record"], runs["record_scale"])]
table = pa.table(runs).append_column("pgv_m_s", pa.array(intensity))
fitted = mrbd.fragility(table, intensity="pgv_m_s", outcome="outcome", cluster=["record", "wall"], replicates=200)
fitted

# %%
ax = fitted.plot()
ax.set(xlabel="peak ground velocity, m/s", ylabel="probability of collapse")
