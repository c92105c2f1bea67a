"""Questions of a single wall: its capacity as it is pushed, the code's check, its margin, its risk."""

from __future__ import annotations

import json
import tempfile
import warnings
from html import escape
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from mrbd._fragility import Fragility
from mrbd._mrbd import Wall, ask
from mrbd._pages import frame
from mrbd._progress import Progress, of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_Path = str | PathLike[str]
_Options = dict[str, Any]


class _Answer:
    """What a command answers: its JSON, its lines for people, its notes, its page."""

    _command: ClassVar[str]

    def __init__(self, answer: tuple[str, str, list[str]], page: str | None) -> None:
        text, self._text, notes = answer
        self.json: dict[str, Any] = json.loads(text)
        """Everything, as the command prints it with `--json`."""
        self.notes: list[str] = [note.removeprefix("note: ") for note in notes]
        """What a reader should know beside it, each a sentence."""
        self._page = page

    def html(self) -> str:
        """The page of the results."""
        return self._page or f"<pre>{escape(self._text)}</pre>"

    def _repr_html_(self) -> str:
        return frame(self._page) if self._page else self.html()

    def __repr__(self) -> str:
        return "\n".join([*self.notes, self._text.rstrip()])


class Push(_Answer):
    """Force against displacement of a wall that is pushed slowly."""

    def _column(self, curve: str, name: str) -> NDArray[np.float64]:
        import numpy as np

        return np.array([point[name] for point in self.json[curve]["points"]])

    @property
    def displacement_m(self) -> NDArray[np.float64]:
        """Displacement of the place that `json["displacement_of"]` names, m."""
        return self._column("curve", "displacement_m")

    @property
    def force_n(self) -> NDArray[np.float64]:
        """Force, N; of a uniform acceleration the sum over the masses."""
        return self._column("curve", "force_n")

    @property
    def force_over_weight(self) -> NDArray[np.float64]:
        """Force over the weight of the wall."""
        return self._column("curve", "force_over_weight")

    def plot(self, ax: Any = None) -> Any:
        """Draw the wall's curve and its rigid line by matplotlib; the axes."""
        from mrbd._plots import push as draw

        return draw(self, ax)

    def __repr__(self) -> str:
        return f"<mrbd.Push {'; '.join(self.notes)}>"


class Assessment(_Answer):
    """The code's check of a wall, and what the dynamics say of it."""

    @property
    def alpha_0(self) -> float:
        """Multiplier α_0 at which the mechanism begins."""
        return float(self.json["alpha_0"])

    @property
    def zeta(self) -> float | None:
        """ζ = a_g,SLV over that of the site, by the nonlinear check; `None` beyond 10 g."""
        zeta: float | None = self.json["zeta"]
        return zeta


class Margin(_Answer):
    """The factor on each record that overturns a wall, and its fragility."""

    @property
    def scales(self) -> dict[str, float | None]:
        """The lowest factor found to exceed the limit, by record; `None` where none was."""
        return {record["record"]: record["scale"] for record in self.json["records"]}


class Risk(_Answer):
    """Annual rates of limit states."""

    @property
    def limit_states(self) -> list[dict[str, Any]]:
        """Each limit state with its rate, its return period and their intervals."""
        states: list[dict[str, Any]] = self.json["limit_states"]
        return states


def _words(options: _Options) -> list[str]:
    """Keywords as the words of the command; the unit at a keyword's end is no part of the option."""
    words = []
    for keyword, value in options.items():
        option = "--" + keyword.removesuffix("_pa_per_m").removesuffix("_s").replace("_", "-")
        if value is True:
            words.append(option)
        elif value is not None and value is not False:
            words.append(f"{option}={fspath(value) if isinstance(value, PathLike) else value}")
    return words


def _wall_file(wall: Wall | _Path, folder: Path) -> str:
    """The file of a wall; of a wall that is none, one in a folder, under the name of the file it was read from."""
    if not isinstance(wall, Wall):
        return fspath(wall)
    folder.mkdir()
    file = folder / ("wall.toml" if wall.file.startswith("mrbd.") else Path(wall.file).name)
    wall.write(file)
    return str(file)


def _asked(command: str, words: list[str], progress: Progress | None = None) -> tuple[str, str, list[str]]:
    answer = ask([command, *words], progress)
    for note in answer[2]:
        if note.startswith("note: "):
            warnings.warn(note.removeprefix("note: "), stacklevel=4)
    return answer


def push(
    wall: Wall | _Path,
    *,
    at: Literal["crack", "uniform", "top"] = "uniform",
    side: Literal["right", "left"] = "right",
    held: bool = False,
    bed_pa_per_m: float | None = None,
    measured: _Path | None = None,
    out: _Path | None = None,
    force: bool = False,
) -> Push:
    """Push a wall slowly until it falls: force against displacement, as `mrbd push` does.

    The arguments are the options of the command. The files of the results go to `out`, if it is given.
    """
    options = {"at": at, "side": side, "held": held, "bed_pa_per_m": bed_pa_per_m, "measured": measured, "force": force}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(out or Path(temporary) / "pushed")
        words = [_wall_file(wall, Path(temporary) / "wall"), *_words({**options, "out": folder})]
        return Push(_asked("push", words), _page(folder))


def assess(
    wall: Wall | _Path,
    site: _Path,
    *,
    records: _Path | None = None,
    compare: Wall | _Path | None = None,
    language: Literal["en", "it"] = "en",
    out: _Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: bool | Progress = True,
) -> Assessment:
    """Check a wall against the Italian code, and by its own dynamics under records of the site, as `mrbd assess` does.

    The arguments are the options of the command. The files of the results go to `out`, if it is given.
    """
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(out or Path(temporary) / "assessed")
        other = None if compare is None else _wall_file(compare, Path(temporary) / "compared")
        options = {"site": site, "records": records, "compare": other, "language": language, "threads": threads}
        words = _words({**options, "out": folder, "force": force})
        words = [_wall_file(wall, Path(temporary) / "wall"), *words]
        return Assessment(_asked("assess", words, of(progress, "runs")), _page(folder))


def margin(
    wall: Wall | _Path,
    suite: _Path,
    *,
    limit: Literal["collapse"] | float = "collapse",
    range: tuple[float, float] = (0.25, 32.0),
    growth: float = 1.1,
    bracket: float = 1.01,
    tail_s: float = 5.0,
    tolerance: float = 1e-6,
    out: _Path | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: bool | Progress = True,
) -> Margin:
    """Find the smallest factor on each record of a suite that overturns a wall, as `mrbd margin` does.

    The arguments are the options of the command; `range` holds `--from` and `--to`. The files of the results go to
    `out`, if it is given.
    """
    options = {"suite": suite, "limit": limit, "from": range[0], "to": range[1], "growth": growth, "bracket": bracket}
    options |= {"tail_s": tail_s, "tolerance": tolerance, "force": force, "threads": threads}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(out or Path(temporary) / "margin")
        words = [_wall_file(wall, Path(temporary) / "wall"), *_words({**options, "out": folder})]
        return Margin(_asked("margin", words, of(progress, "records")), _page(folder))


def risk(fragility: Fragility | Margin | _Path, hazard: _Path, *, years: float | None = None) -> Risk:
    """Annual rate and return period of each limit state, as `mrbd risk` does.

    `fragility` is what `mrbd.fragility` or `mrbd.margin` found, or a file with fragilities; `hazard` is a hazard curve
    (.csv, .xml).
    """
    with tempfile.TemporaryDirectory() as temporary:
        file = Path(temporary) / "fragility.json"
        if isinstance(fragility, (Fragility, Margin)):
            file.write_text(json.dumps(fragility.json), encoding="utf-8")
        else:
            file = Path(fragility)
        return Risk(_asked("risk", [str(file), *_words({"hazard": hazard, "years": years})]), None)


def _page(folder: Path) -> str:
    return (folder / "report.html").read_text(encoding="utf-8")
