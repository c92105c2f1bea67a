# %% [markdown]
# # A first wall
#
# A brick façade 4 m high, cracked at mid-height, under a floor of timber beams. How far does it rotate in an earthquake?

# %%
import numpy as np

import mrbd

wall = mrbd.Wall(
    thickness_m=0.291,
    height_m=3.984,
    crack_height_m=2.191,
    length_m=1.5,
    mass_kg=3614.0,
    diaphragm=mrbd.Diaphragm(mass_kg=179.0, carriage_mass_kg=663.0, stiffness_n_per_m=37e3),
)
wall

# %% [markdown]
# Before any run: the steady acceleration at which a joint opens.

# %%
opening = wall.describe()["opening"]
print(f"opens at {opening['ground_g']:.3f} g at the ground, {opening['crack_g']:.3f} g at the crack")

# %% [markdown]
# A pulse of one second. A record of your own is `mrbd.Record.read("quake.AT2")`, in any of the usual formats.

# %%
time_s = np.arange(0.0, 1.0, 0.005)
pulse = mrbd.Record(3.0 * np.sin(2 * np.pi * time_s), step_s=0.005, name="one sine")
run = mrbd.simulate(wall, pulse, members="auto")
print(run)
print(*run.remarks, sep="\n")

# %% [markdown]
# In a notebook a run shows the wall in motion. Its history is a table of any library, and a plot in one line.

# %%
run

# %%
largest = np.abs(run.theta1_rad).argmax()
print(
    f"largest rotation at a sample {run.theta1_rad[largest]:.4f} rad at {run.time_s[largest]:.3f} s, pattern {run.pattern[largest]}"
)
ax = run.plot()

# %% [markdown]
# Twice as strong, and three times: does it fall?

# %%
for scale in (1.0, 2.0, 3.0, 4.0):
    stronger = mrbd.simulate(wall, pulse, scale=scale)
    print(scale, "collapsed" if stronger.collapsed else "stood", stronger.summary["theta1_max_over_alpha1"])
