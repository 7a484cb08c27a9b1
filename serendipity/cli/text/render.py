"""Answers as JSON, rows or text, which rich colours and folds on a terminal.

rich takes longer to load than a plan to find, so what is piped does without it.
"""

import io
import shutil
import sys
from collections.abc import Iterable
from itertools import zip_longest
from typing import TYPE_CHECKING, Any, Final

from serendipity.model.telling import GAP, Grid, Line, as_text
from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import written

if TYPE_CHECKING:
    from rich.console import RenderableType

_WHOLE: Final = 12
"""Characters up to which a cell is not folded; longer ones are between words."""


def rendered(parts: Iterable[Line | Grid], *, terminal: bool | None = None) -> str:
    """Text for stdout or a file; on a terminal (None asks stdout) with colours, and folded to its width."""
    if (sys.stdout is not None and sys.stdout.isatty()) if terminal is None else terminal:
        return _coloured([part.printable() for part in parts])
    return as_text(parts)


def shown(answer: Any, form: str, **how: Any) -> str | bytes:
    """An answer with ``to_json``, ``told`` and perhaps a ``table``: as JSON, as text, or as rows."""
    if form == "json":
        return str(answer.to_json())
    if form in ROWS:
        return written(answer.table(), form)
    return rendered(answer.told(**how))


def _coloured(parts: Iterable[Line | Grid]) -> str:
    from rich.console import Console

    width = shutil.get_terminal_size().columns
    console = Console(file=io.StringIO(), width=width, force_terminal=True, highlight=False)
    with console.capture() as captured:
        for part in parts:
            console.print(_renderable(part, width))
    return captured.get()


def _renderable(part: Line | Grid, width: int) -> "RenderableType":
    from rich.table import Table
    from rich.text import Text

    if isinstance(part, Line):
        return Text(part.text, style=part.style)
    least = [_least(cells) for cells in zip_longest(part.header, *part.rows, fillvalue="")]
    if sum(least) + GAP * (len(least) - 1) > width:
        return Text(as_text([part]).removesuffix("\n"), overflow="fold")
    table = Table(box=None, pad_edge=False, padding=(0, GAP, 0, 0), header_style="bold")
    for i, heading in enumerate(part.header):
        table.add_column(
            Text(heading), justify="right" if part.numbered and i == 0 else "left", min_width=least[i]
        )
    for i, row in enumerate(part.rows):
        table.add_row(*(Text(cell) for cell in row), style="bold" if i in part.marked else None)
    return table


def _least(cells: Iterable[str]) -> int:
    """How narrow a column may get."""
    return max(len(cell) if len(cell) <= _WHOLE else max(_WHOLE, *map(len, cell.split())) for cell in cells)
