"""Records: suites read, generated and selected."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from os import PathLike

from mrbd._mrbd import Record, generate_suite, read_suite, select_suite
from mrbd._pages import record

__all__ = ["Selection", "Suite", "generate", "read", "select", "suite"]

_Path = str | PathLike[str]

read = Record.read


@dataclass(frozen=True)
class Suite(Sequence[Record]):
    """Records that belong together: a sequence of them."""

    name: str
    """Name of the suite."""
    records: list[Record]
    """Horizontal components, scaled as the suite says."""
    verticals: list[Record] | None = None
    """Vertical components, where every record has one."""

    def __len__(self) -> int:
        return len(self.records)

    def __getitem__(self, index):  # type: ignore[no-untyped-def]
        return self.records[index]

    def __repr__(self) -> str:
        return f"<mrbd.records.Suite {self.name!r}: {len(self.records)} records>"

    def _repr_html_(self) -> str:
        return "".join(record(each) for each in self.records)

    def __iter__(self) -> Iterator[Record]:
        return iter(self.records)


def suite(path: _Path) -> Suite:
    """Read a suite file."""
    return Suite(*read_suite(path))


def generate(
    table: _Path | None = None,
    *,
    site: _Path | None = None,
    seed: int = 20_120_529,
    name: str = "generated",
    out: _Path | None = None,
) -> Suite:
    """Generate records with the peaks of a published table, the paper's Table 4 unless given.

    The same seed gives the same samples, to the bit. `out` is a folder to write the suite to.
    """
    return Suite(name, generate_suite(table, site, seed, name, out))


@dataclass(frozen=True)
class Selection:
    """A suite that fits."""

    names: list[str]
    """Names of its records."""
    scales: list[float]
    """Their factors."""
    deviation_rms: float
    """Root mean square of the deviation of the mean spectrum from the code's."""
    deviation: tuple[float, float]
    """Its lowest and highest value."""


def select(
    from_records: _Path,
    site: _Path,
    *,
    count: int = 7,
    periods_s: tuple[float, float] = (0.15, 2.0),
    deviation: tuple[float, float] = (-0.1, 0.3),
    scale: tuple[float, float] = (0.5, 3.0),
    most_of_event: int = 2,
    candidates: int = 30,
    best: int = 5,
    step_s: float | None = None,
) -> list[Selection]:
    """Select suites of a folder or a suite file whose mean spectrum fits the code spectrum of a site, the best first."""
    found = select_suite(
        from_records, site, count, periods_s, deviation, scale, most_of_event, candidates, best, step_s
    )
    return [Selection(names, scales, rms, (low, high)) for names, scales, rms, (low, high) in found]
