"""What a notebook shows: pages of the program, tables, records."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mrbd import Record, Table

WIDTH, HEIGHT = 640, 80
"""Of the drawing of a record."""
ROWS = 10
"""Rows of a table that are shown."""


def frame(page: str) -> str:
    """A page as a frame of its own: its scripts and styles touch nothing around it."""
    return (
        f'<iframe srcdoc="{escape(page)}" style="width:100%;height:720px;border:0" '
        'sandbox="allow-scripts allow-same-origin"></iframe>'
    )


def table(shown: Table) -> str:
    """The first rows of a table."""
    first = shown.head(ROWS)
    head = "".join(f"<th>{escape(name)}</th>" for name in shown.columns)
    cells = zip(*(first[name] for name in shown.columns), strict=True)
    body = "".join("<tr>" + "".join(f"<td>{_text(cell)}</td>" for cell in row) + "</tr>" for row in cells)
    more = f"<p>{len(shown):,} rows</p>" if len(shown) > ROWS else ""
    return f'<div style="overflow-x:auto"><table><tr>{head}</tr>{body}</table></div>{more}'


def _text(cell: object) -> str:
    if cell is None or cell != cell:
        return ""
    return f"{cell:.6g}" if isinstance(cell, float) else escape(str(cell))


def record(shown: Record) -> str:
    """The acceleration over time: the least and the most of every piece as wide as a point."""
    import numpy as np

    samples = np.array_split(shown.acceleration_m_s2, min(WIDTH, len(shown)))
    peak = max(float(np.abs(shown.acceleration_m_s2).max()), 1e-300)
    x = np.linspace(0, WIDTH, len(samples))
    ends = [(piece.min(), piece.max()) for piece in samples]
    line = "".join(f"L{at:.1f} {HEIGHT * (0.5 - 0.48 * end / peak):.1f}" for at, both in zip(x, ends) for end in both)
    what = f"{shown.name}: {shown.duration_s:g} s, peak {peak:.3f} m/s²"
    return (
        f"<figure><figcaption>{escape(what)}</figcaption>"
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" role="img" aria-label="{escape(what)}">'
        f'<path d="M0 {HEIGHT / 2}{line}" fill="none" stroke="#333"/></svg></figure>'
    )
