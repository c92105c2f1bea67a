"""The laboratory: measured tests become coefficients, or the effect that the model lacks."""

from __future__ import annotations

import json
import tempfile
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from mrbd._mrbd import Table, Wall, read_parquet, run_calibration, run_diagnosis, write_page
from mrbd._pages import frame
from mrbd._progress import Progress, of

_Path = str | PathLike[str]


class _Found:
    """What the laboratory found: its JSON, the wall, its page."""

    def __init__(self, folder: Path, results: str, wall: str) -> None:
        self.json: dict[str, Any] = json.loads((folder / results).read_text(encoding="utf-8"))
        self.wall = Wall.parse((folder / wall).read_text(encoding="utf-8"), wall)
        self._page = write_page(folder).read_text(encoding="utf-8")

    def html(self) -> str:
        """The page of the results."""
        return self._page

    def _repr_html_(self) -> str:
        return frame(self._page)


class Diagnosis(_Found):
    """Where model and measurement disagree, and which effect would make them agree."""

    json: dict[str, Any]
    """Everything, as in diagnosis.json."""
    wall: Wall
    """The wall with the effects added."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "diagnosis.json", "wall.updated.toml")

    @property
    def verdict(self) -> str:
        """`none`, `recalibrated`, `named`, `class`, `place_only`, `unknown`, `no_power`, ..."""
        return str(self.json["verdict"])

    @property
    def effects(self) -> list[dict[str, Any]]:
        """The effects found, with parameters and intervals."""
        effects: list[dict[str, Any]] = self.json["effects"]
        return effects

    def rivals(self) -> list[dict[str, Any]]:
        """Every candidate that was tried, with the same figures."""
        rivals: list[dict[str, Any]] = self.json["rivals"]
        return rivals

    def __repr__(self) -> str:
        names = ", ".join(f"{effect.get('name') or 'a law'} at {effect['place']}" for effect in self.effects)
        return f"<mrbd.Diagnosis {self.verdict}{': ' + names if names else ''}>"


class Calibration(_Found):
    """Coefficients and other numbers of a wall from measured tests."""

    json: dict[str, Any]
    """Everything, as in calibration.json."""
    wall: Wall
    """The wall with the vector for all tests."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "calibration.json", "wall.calibrated.toml")
        self._candidates = read_parquet(folder / "candidates.parquet")

    @property
    def values(self) -> dict[str, float]:
        """The joint vector, by parameter."""
        names = [parameter["name"] for parameter in self.json["parameters"]]
        return dict(zip(names, self.json["joint"]["values"]))

    def candidates(self) -> Table:
        """Every simulation."""
        return self._candidates

    def __repr__(self) -> str:
        values = ", ".join(f"{name} {value:.4g}" for name, value in self.values.items())
        return f"<mrbd.Calibration {values}>"


def diagnose(
    experiment: _Path, out: _Path | None = None, *, threads: int | None = None, progress: bool | Progress = True
) -> Diagnosis:
    """Find where model and measurement disagree and name the missing effect, as `mrbd diagnose` does.

    The files of the results go to `out`, if it is given.
    """
    show = of(progress, "candidates")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(out or Path(temporary) / "diagnosed")
        run_diagnosis(fspath(experiment), folder, threads, show)
        return Diagnosis(folder)


def calibrate(
    experiment: _Path,
    out: _Path | None = None,
    *,
    seed: int | None = None,
    resume: bool = False,
    threads: int | None = None,
    progress: bool | Progress = True,
) -> Calibration:
    """Calibrate a wall to measured tests, as `mrbd calibrate` does.

    The files of the results go to `out`, if it is given; there a stopped calibration can be resumed.
    """
    show = of(progress, "simulations")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(out or Path(temporary) / "calibrated")
        run_calibration(fspath(experiment), folder, seed, resume, threads, show)
        return Calibration(folder)
