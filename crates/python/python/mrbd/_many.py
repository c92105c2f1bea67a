"""Many runs at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

from mrbd import _mrbd
from mrbd._mrbd import Record, Table
from mrbd._progress import Progress, of


def simulate_many(
    walls: Any,
    records: Record | Sequence[Record],
    *,
    scales: Any = None,
    verticals: Record | Sequence[Record] | None = None,
    pairs: Literal["all", "matched"] = "all",
    tail_s: float = 5.0,
    tolerance: float = 1e-6,
    threads: int | None = None,
    progress: bool | Progress = True,
) -> Table:
    """Run many walls under many records on all threads; one row a run, with the columns of result files.

    `walls` are walls, or a table (a data frame) whose rows are walls, under the names of result files. Every wall runs
    under every record at every one of the `scales`, the wall varying fastest; with `pairs="matched"` the first wall runs
    under the first record at the first scale, and so on. A wall that cannot exist is a row with outcome `failed`.

    Ctrl-C raises `Interrupted`, whose `done` is the table of the runs that were done.
    """
    return _mrbd.simulate_many(
        walls,
        records,
        scales=None if scales is None else [scales] if isinstance(scales, (int, float)) else scales,
        verticals=verticals,
        pairs=pairs,
        tail_s=tail_s,
        tolerance=tolerance,
        threads=threads,
        progress=of(progress, "runs"),
    )
