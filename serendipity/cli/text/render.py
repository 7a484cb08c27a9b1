"""Lines and grids as text: coloured and folded by rich on a terminal, plain elsewhere.

rich takes longer to load than a plan to find, so what is piped does without it.
"""

import io
import shutil
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from serendipity.writing.printable import printable

if TYPE_CHECKING:
    from rich.console import RenderableType

_GAP = 3


@dataclass(frozen=True, slots=True)
class Line:
    """A line of text.

    Attributes:
        text: without a line break.
        style: of rich, on a terminal.
    """

    text: str = ""
    style: str = ""


@dataclass(frozen=True, slots=True)
class Grid:
    """A table without rules.

    Attributes:
        header: column headings; the first column is aligned to the right if ``numbered``.
        rows: cells; rows may be shorter than the header.
        marked: indices of the rows that stand out.
        numbered: whether the first column holds numbers.
    """

    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    marked: frozenset[int] = frozenset()
    numbered: bool = False


def rendered(parts: Iterable[Line | Grid], *, terminal: bool | None = None) -> str:
    """Text for stdout, or for a file.

    Args:
        parts: from top to bottom.
        terminal: with colours and folded to the terminal's width; None asks stdout.
    """
    shown = [_printable(part) for part in parts]
    if (sys.stdout is not None and sys.stdout.isatty()) if terminal is None else terminal:
        return _coloured(shown)
    lines: list[str] = []
    for part in shown:
        lines += [part.text] if isinstance(part, Line) else _plain(part)
    return "\n".join(line.rstrip() for line in lines) + "\n"


def as_markdown(parts: Iterable[Line | Grid]) -> str:
    """The same for a page in Markdown: lines as paragraphs, grids as tables."""
    blocks = []
    for part in map(_printable, parts):
        if isinstance(part, Line):
            blocks.append(part.text)
        else:
            rows = [part.header, ["---"] * len(part.header), *part.rows]
            blocks.append("\n".join(f"| {' | '.join(row)} |" for row in rows))
    return "\n\n".join(filter(None, blocks)) + "\n"


def _printable(part: Line | Grid) -> Line | Grid:
    if isinstance(part, Line):
        return replace(part, text=printable(part.text))
    return replace(
        part, header=[*map(printable, part.header)], rows=[[*map(printable, row)] for row in part.rows]
    )


def _plain(grid: Grid) -> list[str]:
    table = [grid.header, *grid.rows]
    columns = range(len(grid.header))
    widths = [max(len(row[i]) for row in table if i < len(row)) for i in columns]
    lines = []
    for row in table:
        cells = [cell.ljust(widths[i]) for i, cell in enumerate(row)]
        if grid.numbered:
            cells[0] = row[0].rjust(widths[0])
        lines.append((" " * _GAP).join(cells))
    return lines


def _coloured(parts: Iterable[Line | Grid]) -> str:
    from rich.console import Console

    width = shutil.get_terminal_size().columns
    console = Console(file=io.StringIO(), width=width, force_terminal=True, highlight=False)
    with console.capture() as captured:
        for part in parts:
            console.print(_renderable(part))
    return captured.get()


def _renderable(part: Line | Grid) -> "RenderableType":
    from rich.table import Table
    from rich.text import Text

    if isinstance(part, Line):
        return Text(part.text, style=part.style)
    table = Table(box=None, pad_edge=False, padding=(0, _GAP, 0, 0), header_style="bold")
    for i, heading in enumerate(part.header):
        table.add_column(Text(heading), justify="right" if part.numbered and i == 0 else "left")
    for i, row in enumerate(part.rows):
        table.add_row(*(Text(cell) for cell in row), style="bold" if i in part.marked else None)
    return table
