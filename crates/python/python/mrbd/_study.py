"""Studies: sweeps, Monte Carlo, fragility studies."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path
from typing import Any

from mrbd._fragility import Fragility, fragility
from mrbd._mrbd import Table, read_parquet, read_runs, run_study, write_page
from mrbd._pages import frame
from mrbd._progress import Progress, of


class Study:
    """The folder of a study that `mrbd run` or `mrbd.study` made."""

    def __init__(self, folder: str | PathLike[str]) -> None:
        self.folder = Path(folder)
        """Where its files are."""

    def runs(self) -> Table:
        """The runs, one a row."""
        return read_runs(self.folder)

    def medians(self) -> Table:
        """Medians and quantiles over records, or over drawn façades."""
        return read_parquet(self.folder / "medians.parquet")

    def fragility(self, **asked: Any) -> Fragility:
        """Fragilities of drawn façades: the arguments of `mrbd.fragility`."""
        return fragility(self.folder, **asked)

    def html(self, site: str | PathLike[str] | None = None) -> str:
        """The page of the study, made in its folder as `mrbd report` does."""
        return write_page(self.folder, site).read_text(encoding="utf-8")

    def _repr_html_(self) -> str:
        return frame(self.html())

    def __repr__(self) -> str:
        return f"<mrbd.Study in {str(self.folder)!r}>"


def study(
    pipeline: str | PathLike[str],
    out: str | PathLike[str] | None = None,
    *,
    suite: str | PathLike[str] | None = None,
    resume: bool = False,
    force: bool = False,
    threads: int | None = None,
    progress: bool | Progress = True,
) -> Study:
    """Run a study: plan it, run it on all threads, store every run, as `mrbd run` does.

    Without `out` the folder is outputs/<name of the pipeline>. Ctrl-C stores what is done; `resume=True` goes on.
    `force=True` replaces the results of an earlier study.
    """
    if resume and force:
        raise ValueError("resume goes on with an earlier study and force replaces it: one of the two")
    earlier = "resume" if resume else "replace" if force else "refuse"
    folder = run_study(fspath(pipeline), out, suite, earlier, threads, of(progress, "runs"))
    return Study(folder)
