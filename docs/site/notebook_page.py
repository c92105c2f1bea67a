"""A notebook, run, as a page: its texts, its cells and what they show. `notebook_page.py NOTEBOOK FOLDER`.

The page is FOLDER/notebooks/NAME.md, its pictures FOLDER/pictures/NAME-N.svg, pages that it shows FOLDER/_extra/pages/.
"""

import ast
import contextlib
import io
import os
import re
import sys
from pathlib import Path

os.environ["MPLBACKEND"] = "agg"


class Page:
    """What a notebook becomes."""

    def __init__(self, notebook: Path, folder: Path) -> None:
        self.name, self.folder = notebook.stem, folder
        self.cells = re.split(r"^# %%", notebook.read_text(encoding="utf-8"), flags=re.M)[1:]
        self.names = {"__name__": "__main__"}
        self.lines: list[str] = []
        self.pictures = self.pages = 0

    def write(self) -> None:
        for cell in self.cells:
            head, _, body = cell.partition("\n")
            if "markdown" in head:
                self.text(re.sub(r"^# ?", "", body, flags=re.M).strip())
            else:
                self.code(body.strip())
        path = self.folder / "notebooks" / f"{self.name}.md"
        path.write_text("\n\n".join(self.lines) + "\n", encoding="utf-8")

    def text(self, text: str) -> None:
        self.lines.append(text)
        smaller = [name for name in ("MRBD_FACADES", "MRBD_WALLS") if any(name in cell for cell in self.cells)]
        if text.startswith("# ") and smaller:
            values = ", ".join(f"`{name}={os.environ[name]}`" for name in smaller if name in os.environ)
            self.lines.append(f"*Run for this page with {values}.*")

    def code(self, code: str) -> None:
        self.lines.append(f"```python\n{code}\n```")
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            shown = self.run(code)
        if printed.getvalue():
            self.lines.append(f"```text\n{printed.getvalue().rstrip()}\n```")
        self.figures()
        if shown is not None and not type(shown).__module__.startswith("matplotlib") and not isinstance(shown, list):
            self.show(shown)

    def run(self, code: str):
        """Runs a cell; the value of its last expression."""
        body = ast.parse(code, self.name).body
        last = body.pop() if body and isinstance(body[-1], ast.Expr) else None
        exec(compile(ast.Module(body, []), self.name, "exec"), self.names)
        return None if last is None else eval(compile(ast.Expression(last.value), self.name, "eval"), self.names)

    def figures(self) -> None:
        if "matplotlib.pyplot" not in sys.modules:
            return
        from matplotlib import pyplot

        for number in pyplot.get_fignums():
            self.pictures += 1
            picture = f"pictures/{self.name}-{self.pictures}.svg"
            # Without a date and with fixed names, so that the same run draws the same file.
            pyplot.rcParams["svg.hashsalt"] = "mrbd"
            pyplot.figure(number).savefig(self.folder / picture, metadata={"Date": None})
            self.lines.append(f"![A picture of this notebook](../{picture})")
        pyplot.close("all")

    def show(self, shown: object) -> None:
        if hasattr(shown, "html"):
            self.pages += 1
            page = f"pages/{self.name}-{self.pages}.html"
            (self.folder / "_extra" / page).write_text(shown.html(), encoding="utf-8")
            self.lines.append(f'```{{raw}} html\n<iframe src="../{page}"></iframe>\n```')
        elif hasattr(shown, "_repr_html_"):
            self.lines.append(f"````{{raw}} html\n{shown._repr_html_()}\n````")
        else:
            self.lines.append(f"```text\n{shown!r}\n```")


if __name__ == "__main__":
    Page(Path(sys.argv[1]), Path(sys.argv[2])).write()
