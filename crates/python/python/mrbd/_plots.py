"""One-line plots, where matplotlib is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mrbd import Fragility, Push, Run

LOWER, UPPER = "#0072b2", "#d55e00"


def axes(ax: Any) -> Any:
    """The axes given, or new ones."""
    if ax is not None:
        return ax
    from matplotlib import pyplot

    return pyplot.subplots(figsize=(8, 3), layout="constrained")[1]


def history(run: Run, ax: Any = None) -> Any:
    """Rotations over time."""
    ax = axes(ax)
    cracked = run.wall.crack_height_m is not None
    ax.plot(run.time_s, 1e3 * run.theta1_rad, color=LOWER, label="θ₁, lower body" if cracked else "θ")
    if cracked:
        ax.plot(run.time_s, 1e3 * run.theta2_rad, color=UPPER, label="θ₂, upper body")
    ax.set(xlabel="time, s", ylabel="rotation, mrad")
    ax.legend()
    return ax


def fragility(fitted: Fragility, ax: Any = None) -> Any:
    """Probabilities of failure over intensity, with their intervals."""
    ax = axes(ax)
    for curve in fitted.curves():
        label = ", ".join(curve["group"].values()) or None
        (line,) = ax.plot(curve["intensity"], curve["probability"], label=label)
        ax.fill_between(curve["intensity"], curve["lower"], curve["upper"], color=line.get_color(), alpha=0.15, lw=0)
    ax.set(xlabel="intensity", ylabel="probability of failure", ylim=(0, 1))
    if any(curve["group"] for curve in fitted.curves()):
        ax.legend()
    return ax


def push(pushed: Push, ax: Any = None) -> Any:
    """Force over weight against displacement, with the rigid line."""
    ax = axes(ax)
    rigid = pushed.json["rigid"]["points"]
    ax.plot(pushed.displacement_m, pushed.force_over_weight, color=LOWER, label="the wall")
    line = [[point[name] for point in rigid] for name in ("displacement_m", "force_over_weight")]
    ax.plot(*line, color="0.5", ls="--", label="its rigid line")
    ax.set(xlabel=f"displacement of the {pushed.json['displacement_of']}, m", ylabel="force over weight")
    ax.legend()
    return ax
