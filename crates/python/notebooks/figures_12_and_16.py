# %% [markdown]
# # The paper's Figs. 12 and 16 again
#
# Medians over seven records of the largest rotation over α, for façades of growing slenderness: how the size of the façade
# (Fig. 12) and the stiffness of its floor (Fig. 16) decide it, under floors whose beams rest on the façade or run along it.

# %%
import os
import tempfile
from pathlib import Path

import polars as pl
from matplotlib import pyplot

import mrbd

ROOT = Path(os.environ.get("MRBD_REPOSITORY", "../../.."))
out = Path(os.environ.get("MRBD_OUT", tempfile.mkdtemp())) / "sweep"
study = mrbd.study(ROOT / "pipelines/sweep.toml", out=out, force=True)
runs = study.runs().to_polars()

# %% [markdown]
# A wall that collapsed has rotated farther than any that stood.

# %%
rotation = pl.when(outcome="collapsed").then(float("inf"))
medians = (
    runs.with_columns(pl.col(pl.Categorical).cast(pl.String))
    .filter(pl.col("variant") == "base", pl.col("parameter").is_in(["thickness", "stiffness"]))
    .with_columns(
        rotation.otherwise(pl.col("theta1_max_over_alpha1")).alias("lower body"),
        rotation.otherwise(pl.col("theta2_max_over_alpha2")).alias("upper body"),
    )
    .group_by("parameter", "configuration", "level", "slenderness")
    .agg(pl.median("lower body", "upper body"))
    .sort("slenderness")
)
medians

# %%
LEVELS = {"mu_minus_sigma": ":", "mu": "-", "mu_plus_sigma": "--"}
for parameter, name in [("thickness", "Fig. 12"), ("stiffness", "Fig. 16")]:
    figure, axes = pyplot.subplots(2, 2, figsize=(9, 6), sharex=True, layout="constrained")
    figure.suptitle(f"{name}: {parameter}")
    for row, body in zip(axes, ["lower body", "upper body"]):
        for ax, configuration in zip(row, ["perpendicular", "parallel"]):
            for level, style in LEVELS.items():
                line = medians.filter(parameter=parameter, configuration=configuration, level=level)
                # A median that collapsed is drawn at the top.
                ax.plot(line["slenderness"], line[body].clip(upper_bound=1.0), style, label=level)
            ax.set(title=f"{body}, {configuration} floor", xlabel="h/b", ylabel="median max |θ|/α", ylim=(0, 1))
    axes[0, 0].legend()
