"""The site of documentation: `make site`. `build.py RUSTDOC OUT` with the wheel installed.

The guide, the notebooks as they run, the API of Python from its docstrings, the API of Rust as `cargo doc` made it, and a
gallery of the pictures that notebooks and commands draw. No page needs the network.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from api import python_api

SITE = Path(__file__).resolve().parent
ROOT = SITE.parents[1]
NOTEBOOKS = ["first_wall", "facade_class", "laboratory", "figures_12_and_16", "million_walls", "dask_workers"]
THEORY = ["model", "typical-values", "measured-walls", "how-sure", "sequences"]
FILES = ["files", "columns"]
GUIDE = ["laboratory", "python", "commands", "calibration", "diagnosis", "assessment"]
# Smaller than for people: the site is made whenever anything changes.
SMALLER = {"MRBD_FACADES": "100", "MRBD_WALLS": "20000"}
WALL = "inputs/walls/table_wall.toml"
RECORD = "inputs/records/emilia7/generated_4_600ya.csv"
DRAWN = {
    "wall.svg": ("The wall of the paper's Table 1", ["describe", WALL]),
    "run.svg": ("The wall in an earthquake", ["simulate", WALL, "--record", RECORD, "--scale", "3.05"]),
    "fall.svg": ("The same, a little stronger", ["simulate", WALL, "--record", RECORD, "--scale", "6"]),
    "push.svg": (
        "A wall that was pushed in a laboratory, and the model",
        [
            *("push", "inputs/measured/griffith_2004/wall.toml", "--at", "crack", "--held"),
            *("--measured", "inputs/measured/griffith_2004/push.csv"),
        ],
    ),
}
"""Pictures of commands, with their captions."""


def lay_out(source: Path) -> None:
    """The pages as Sphinx reads them."""
    for folder in ("notebooks", "pictures", "_extra/pages"):
        (source / folder).mkdir(parents=True)
    shutil.copytree(SITE / "_static", source / "_static")
    shutil.copy(SITE / "conf.py", source)
    shutil.copytree(ROOT / "docs", source, dirs_exist_ok=True, ignore=shutil.ignore_patterns("site", "README.md"))
    (source / "project.md").write_text((ROOT / "README.md").read_text(encoding="utf-8"), encoding="utf-8")
    for page in source.glob("*.md"):
        page.write_text(linked(page.read_text(encoding="utf-8"), source), encoding="utf-8")
    for name in NOTEBOOKS:
        script = ROOT / "crates/python/notebooks" / f"{name}.py"
        environment = os.environ | SMALLER | {"MRBD_REPOSITORY": str(ROOT)}
        subprocess.run([sys.executable, SITE / "notebook_page.py", script, source], check=True, env=environment)
    (source / "python-api.rst").write_text(python_api(), encoding="utf-8")
    (source / "gallery.md").write_text(gallery(source), encoding="utf-8")
    (source / "index.md").write_text(index(), encoding="utf-8")


def linked(text: str, source: Path) -> str:
    """A page of the repository as one of the site: links to files that are none of its pages become plain text."""

    def link(found: re.Match[str]) -> str:
        label, target = found.groups()
        path, _, part = target.partition("#")
        if re.match(r"[a-z]+:", target) or not path:
            return found.group()
        name = Path(path).name if path != "docs/README.md" else "index.md"
        known = (source / name).is_file() or name in ("index.md", "project.md")
        return f"[{label}]({name}{'#' if part else ''}{part})" if known else label

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]*)\)", link, text).replace("](docs/run.svg)", "](run.svg)")


def gallery(source: Path) -> str:
    """Every picture, with what it was made by."""
    lines = ["# Gallery", "Every picture is made anew with this site, by the command or the notebook beneath it."]
    for file, (caption, words) in DRAWN.items():
        command = ["mrbd", *words]
        subprocess.run(
            [*command, "--plot", source / "pictures" / file], check=True, cwd=ROOT, stdout=subprocess.DEVNULL
        )
        lines.append(f"![{caption}](pictures/{file})")
        lines.append(f"{caption}: `{' '.join(command)} --plot {file}`")
    for name in NOTEBOOKS:
        for picture in sorted((source / "pictures").glob(f"{name}-*.svg")):
            lines += [f"![A picture of the notebook](pictures/{picture.name})", f"From [](notebooks/{name}.md)"]
    return "\n\n".join(lines) + "\n"


def rust_api(rustdoc: Path) -> str:
    """Links to what `cargo doc` made of each crate."""
    crates = sorted(path.parent.name for path in rustdoc.glob("mrbd*/index.html"))
    links = "\n".join(f'<li><a href="rust/{crate}/index.html"><code>{crate}</code></a></li>' for crate in crates)
    head = "# API of Rust\n\nThe program is a library too; `mrbd` is its first page, and `mrbd_kernel` holds the model.\n\n"
    return f"{head}````{{raw}} html\n<ul>{links}</ul>\n````\n"


def index() -> str:
    """The first page, with the tree of all others."""
    placed = {*GUIDE, *THEORY, *FILES, "README"}
    others = sorted(page.stem for page in (ROOT / "docs").glob("*.md") if page.stem not in placed)
    parts = {
        "Begin": ["project"],
        "Guide": [*GUIDE, *others],
        "Theory and verification": THEORY,
        "File formats": FILES,
        "Notebooks": [f"notebooks/{name}" for name in NOTEBOOKS],
        "Reference": ["python-api", "rust-api", "gallery"],
    }
    trees = [
        "\n".join(["```{toctree}", f":caption: {caption}", ":maxdepth: 1", "", *pages, "```"])
        for caption, pages in parts.items()
    ]
    head = (
        "# mrbd\n\nWill this masonry wall fall out of its plane? Multi-rocking-body dynamics of unreinforced masonry walls: "
        "a program, a library for Rust and a package for Python.\n\n```sh\npip install mrbd-*.whl\nmrbd init first\n```"
    )
    return "\n\n".join([head, *trees]) + "\n"


def main() -> None:
    rustdoc, out = Path(sys.argv[1]), Path(sys.argv[2])
    source = out.with_name("site-source")
    for old in (source, out):
        shutil.rmtree(old, ignore_errors=True)
    lay_out(source)
    (source / "rust-api.md").write_text(rust_api(rustdoc), encoding="utf-8")
    shutil.copytree(rustdoc, source / "_extra/rust")
    # Without warnings: a link to nowhere, a name that is not documented.
    subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", source, out], check=True)


if __name__ == "__main__":
    main()
