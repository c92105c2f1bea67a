"""Progress on one line of stderr, in terminals and notebooks."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

Progress = Callable[[int, int], object]
"""Called with the parts done and all of them; all is 0 where nobody knows beforehand."""


def of(progress: bool | Progress, what: str) -> Progress | None:
    """What a call shows its progress to: a line for `True`, a callable as it is."""
    if progress is True:
        return Line(what) if _is_watched() else None
    return progress or None


def _is_watched() -> bool:
    notebook = "ipykernel" in sys.modules
    return notebook or sys.stderr.isatty()


class Line:
    """A line that is written again and again, at most twice a second."""

    def __init__(self, what: str) -> None:
        self.what, self.begun, self.next = what, time.monotonic(), 0.5

    def __call__(self, done: int, parts: int) -> None:
        gone = time.monotonic() - self.begun
        is_last = done == parts and self.next > 0.5
        if gone < self.next and not is_last:
            return
        self.next = gone + 0.5
        share = f" of {parts:,} ({100 * done / parts:.0f} %)" if parts else ""
        end = "\n" if is_last else ""
        print(f"\r{done:,}{share} {self.what}, {gone:.0f} s", end=end, file=sys.stderr, flush=True)
