# %% [markdown]
# # A laboratory test becomes a diagnosis
#
# A wall was tested on a shaking table. The model without the right effects cannot follow what was measured; which effect is
# missing? Here the tests are made up, so that the answer is known: a viscous damper at the top that the model is not told of.

# %%
import tempfile
from pathlib import Path

import numpy as np

import mrbd

folder = Path(tempfile.mkdtemp())
wall = mrbd.Wall(
    thickness_m=0.291,
    height_m=3.984,
    crack_height_m=2.191,
    length_m=1.5,
    mass_kg=3614.0,
    diaphragm=mrbd.Diaphragm(mass_kg=179.0, carriage_mass_kg=663.0, stiffness_n_per_m=37e3),
)
truth = wall.replace(effects=[{"kind": "viscous_damping", "coefficient_n_s_per_m": 1500.0}])

# %% [markdown]
# Three tests, with noise of a tenth of a milliradian; the last is held out from every fit.

# %%
random = np.random.default_rng(1)
records = list(mrbd.records.generate())[:3]
experiment = ['wall = "wall.toml"']
wall.write(folder / "wall.toml")
for i, record in enumerate(records):
    record.write(folder / f"record_{i}.csv")
    run = mrbd.simulate(truth, record, scale=2.5)
    noise = random.normal(0.0, 1e-4, (2, len(run.time_s)))
    columns = np.column_stack([run.time_s, run.theta1_rad + noise[0], run.theta2_rad + noise[1]])
    header = "time_s,theta1_rad,theta2_rad"
    np.savetxt(folder / f"measured_{i}.csv", columns, delimiter=",", header=header, comments="", fmt="%.9g")
    use = "hold-out" if i == len(records) - 1 else "fit"
    experiment += [
        "[[tests]]",
        f'name = "test {i}"',
        f'record = "record_{i}.csv"',
        "scale = 2.5",
        f'measured = "measured_{i}.csv"',
        f'use = "{use}"',
    ]
(folder / "experiment.toml").write_text("\n".join(experiment) + "\n")

# %%
diagnosis = mrbd.diagnose(folder / "experiment.toml")
print(diagnosis)
for effect in diagnosis.effects:
    print(effect["name"], effect["parameters"], effect["interval"])

# %% [markdown]
# The wall with the effect added runs like any other, and the page of the diagnosis says what it rests on.

# %%
predicted = mrbd.simulate(diagnosis.wall, records[2], scale=2.5)
measured = mrbd.simulate(truth, records[2], scale=2.5)
print(
    f"largest rotation: predicted {np.abs(predicted.theta1_rad).max():.4f} rad, true {np.abs(measured.theta1_rad).max():.4f} rad"
)
diagnosis
