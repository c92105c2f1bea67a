"""What Python adds to the time of runs, beside the library alone: `make bench-python`.

The library's own work is done by `benches/kernel.rs` in a process beside this one, in turns with the same work from
Python, so that a machine whose speed drifts drifts for both. Processor time is taken, which other programs hardly change.
Linux, where a process can read the clocks of another.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import quantiles

import mrbd

ROOT = Path(__file__).resolve().parents[3]
TURNS = int(sys.argv[1]) if len(sys.argv) > 1 else 15
FACADES = 715
"""Façades drawn; in both configurations under seven records they make 10 010 runs."""
SINGLE_TURNS = 20 * TURNS
"""Turns of one wall: each is short, so that the processor's speed does not change within it."""


class Library:
    """The process beside this one."""

    def __init__(self) -> None:
        manifest = ROOT / "crates/python/Cargo.toml"
        words = ["cargo", "bench", "--quiet", "--locked", "--bench", "kernel", "--manifest-path", manifest]
        self.process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.tasks = Path(f"/proc/{self._answer()}/task")

    def _answer(self) -> int:
        return int(self.process.stdout.readline())

    def _clock_s(self) -> float:
        """Processor time of its threads, which live as long as it does."""
        return sum(int((task / "schedstat").read_text().split()[0]) for task in self.tasks.iterdir()) / 1e9

    def spent_s(self, *words: object) -> tuple[int, float]:
        """Runs that a piece of work made, and its processor time."""
        begun_s = self._clock_s()
        print(*words, sep="\t", file=self.process.stdin, flush=True)
        return self._answer(), self._clock_s() - begun_s

    def close(self) -> None:
        self.process.stdin.close()
        self.process.wait()


def spent_s(work) -> float:
    """Processor time of this process, those of its threads that ended too."""
    begun_s = time.process_time()
    work()
    return time.process_time() - begun_s


def tell(what: str, unit: str, values: list[float]) -> None:
    low, median, high = quantiles(values, n=4)
    print(f"{what:<70} {median:>9.2f} ({low:.2f} to {high:.2f}) {unit}")


def many(library: Library, folder: Path) -> None:
    """A study of drawn façades, without storing."""
    text = (ROOT / "pipelines/monte_carlo.toml").read_text(encoding="utf-8").replace("../inputs", f"{ROOT}/inputs")
    pipeline = folder / "monte_carlo.toml"
    pipeline.write_text(text.replace("count = 1024", f"count = {FACADES}"), encoding="utf-8")
    stored = mrbd.study(pipeline, out=folder / "stored", progress=False).runs().to_pandas()
    walls = mrbd.Table(stored[stored["record"] == stored["record"].iloc[0]])
    suite = mrbd.records.suite(ROOT / "inputs/records/emilia7/suite.toml")
    alone_s, python_s = [], []
    for _ in range(TURNS):
        runs, seconds = library.spent_s("study", pipeline)
        alone_s.append(seconds)
        python_s.append(spent_s(lambda: mrbd.simulate_many(walls, suite, progress=False)))
        assert runs == len(walls) * len(suite) == len(stored)
    per_run = 1e6 / runs
    tell(f"{runs} runs planned and run by the library, not stored, a run", "µs", [s * per_run for s in alone_s])
    tell("the same by mrbd.simulate_many, with their table, a run", "µs", [s * per_run for s in python_s])
    tell("  more than the library", "%", [100 * (p / a - 1) for p, a in zip(python_s, alone_s, strict=True)])


def single(library: Library, folder: Path, duration_s: float, runs: int) -> None:
    """A wall under a record that is cut or lengthened to a duration."""
    wall_file = ROOT / "inputs/walls/table_wall.toml"
    whole = mrbd.records.suite(ROOT / "inputs/records/emilia7/suite.toml")[0]
    samples = round(min(duration_s, whole.duration_s) / whole.step_s) + 1
    wall, record = mrbd.Wall.read(wall_file), mrbd.Record(whole.acceleration_m_s2[:samples], whole.step_s)
    record_file = folder / "record.csv"
    record.write(record_file)
    tail_s = max(duration_s - record.duration_s, 0.0)
    library.spent_s("load", wall_file, record_file, tail_s)
    alone_s, python_s = [], []

    def work() -> None:
        for _ in range(runs):
            mrbd.simulate(wall, record, tail_s=tail_s)

    for _ in range(SINGLE_TURNS):
        alone_s.append(library.spent_s("single", runs)[1])
        python_s.append(spent_s(work))
    per_run = 1e6 / runs
    tell(f"one wall, {duration_s:g} s, by the kernel", "µs", [s * per_run for s in alone_s])
    tell("the same by mrbd.simulate", "µs", [s * per_run for s in python_s])
    tell("  more than the kernel", "µs", [(p - a) * per_run for p, a in zip(python_s, alone_s, strict=True)])


def main() -> None:
    load = Path("/proc/loadavg").read_text().strip()
    print(
        f"processor time: medians and quartiles of {TURNS} turns, of one wall {SINGLE_TURNS}; load of the machine: {load}"
    )
    library = Library()
    with tempfile.TemporaryDirectory() as folder:
        single(library, Path(folder), 30.0, 10)
        # What a call costs, told apart from the noise of a long run.
        single(library, Path(folder), 0.1, 1000)
        many(library, Path(folder))
    library.close()


main()
