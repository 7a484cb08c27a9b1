"""Answers for people: in one line, as text, and as a table in a notebook."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from serendipity.model.printable import markup, message, printable, printable_json

GAP: Final = 3
"""Blanks between columns."""
_LONGEST: Final = 119
"""Characters of a ``repr``."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of text, without a line break, perhaps in a style of rich."""

    text: str = ""
    style: str = ""

    def printable(self) -> "Line":
        """Without characters that can't be seen."""
        return replace(self, text=printable(self.text))


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

    def printable(self) -> "Grid":
        """Without characters that can't be seen."""
        rows = [[*map(printable, row)] for row in self.rows]
        return replace(self, header=[*map(printable, self.header)], rows=rows)


def as_text(parts: Iterable[Line | Grid]) -> str:
    """Lines and grids as plain text, however wide."""
    lines: list[str] = []
    for part in parts:
        shown = part.printable()
        lines += [shown.text] if isinstance(shown, Line) else _plain(shown)
    return "\n".join(line.rstrip() for line in lines) + "\n"


def _plain(grid: Grid) -> list[str]:
    table = [grid.header, *grid.rows]
    columns = range(len(grid.header))
    widths = [max(len(row[i]) for row in table if i < len(row)) for i in columns]
    lines = []
    for row in table:
        cells = [cell.ljust(widths[i]) for i, cell in enumerate(row)]
        if grid.numbered:
            cells[0] = row[0].rjust(widths[0])
        lines.append((" " * GAP).join(cells))
    return lines


def as_html(parts: Iterable[Line | Grid]) -> str:
    """Lines and grids as a piece of a page."""
    return f"<div>{''.join(map(_html, parts))}</div>"


def _html(part: Line | Grid) -> str:
    if isinstance(part, Line):
        text = markup(part.text).replace("  ", "&emsp;")
        shown = f"<b>{text}</b>" if "bold" in part.style else text
        return f'<p style="margin:0;min-height:1ex">{shown}</p>'
    head = "".join(f'<th style="text-align:left">{markup(cell)}</th>' for cell in part.header)
    rows = []
    for i, row in enumerate(part.rows):
        weight = ' style="font-weight:bold"' if i in part.marked else ""
        cells = "".join(f'<td style="text-align:left">{markup(cell)}</td>' for cell in row)
        rows.append(f"<tr{weight}>{cells}</tr>")
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


_STYLE: Final = """
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; margin: 1rem 0; }
.wide { overflow-x: auto; }
th, td { padding: .25rem .75rem; border-bottom: 1px solid #8886; white-space: nowrap; }
svg { width: 100%; min-width: 36rem; max-width: 44rem; height: auto; }
"""


def as_page(title: str, body: str) -> str:
    """A page of HTML that needs nothing else."""
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{markup(title)}</title><style>{_STYLE}</style></head>\n<body>\n"
        f"<h1>{markup(title)}</h1>\n{body}\n</body></html>\n"
    )


def wide(part: str) -> str:
    """A part of a page that scrolls by itself, so that it fits narrow screens."""
    return f'<div class="wide">{part}</div>'


class Told(ABC):
    """An object whose ``repr`` is one line, and which prints as the command line does."""

    __slots__ = ()

    @abstractmethod
    def told(self) -> Iterator[Line | Grid]:
        """The lines that the command line prints."""

    @abstractmethod
    def _in_short(self) -> Iterable[str]:
        """The words between the brackets of its ``repr``."""

    def __repr__(self) -> str:
        return message(f"{type(self).__name__}({', '.join(self._in_short())})", _LONGEST)

    def __str__(self) -> str:
        return as_text(self.told()).removesuffix("\n")

    def _repr_html_(self) -> str:
        return as_html(self.told())


class Output(Told):
    """The answer of a command: told to people, or written as JSON."""

    __slots__ = ()

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""

    def to_json(self) -> str:
        """The JSON text, as the command line writes it."""
        return json_of(self.to_dict())


def counted(number: int, one: str, more: str | None = None) -> str:
    """A number of things in words; ``more`` is what several are called, by default with an ``s``."""
    return f"{number:,} {one if number == 1 else more or f'{one}s'}"


def team(human: str, robots: Sequence[str]) -> str:
    """The human and the robots in words."""
    if not robots:
        return f"human {human}, no robot"
    return f"human {human}, robot{'s' if len(robots) > 1 else ''} {', '.join(robots)}"


def json_of(value: dict[str, Any]) -> str:
    """A JSON object as text, indented; characters that can't be seen are escaped."""
    from serendipity.model.json_text import json_text

    return printable_json(json_text(value)) + "\n"
