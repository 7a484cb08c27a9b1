"""Rows as tables: grouped, a cell for each group and column; as Markdown."""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

from serendipity.evaluation.measuring.figures import percentile
from serendipity.model.telling import Grid, Line

K = TypeVar("K", bound=Hashable)
N = TypeVar("N", bound=tuple[str, ...])
R = TypeVar("R")

Row = Mapping[str, Any]
"""A measurement by the names of its figures."""

Cell = Callable[[Sequence[Any]], object]
"""What a table says of the rows of a group."""


def grouped(rows: Iterable[R], key: Callable[[R], K]) -> dict[K, list[R]]:
    """Rows by their key, in the order in which keys are first met."""
    groups: dict[K, list[R]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def table(names: Sequence[str], groups: Mapping[N, Sequence[R]], columns: Mapping[str, Cell]) -> Grid:
    """A row for each group: what names it, and a cell for each column."""
    lines = [[*key, *(str(cell(of)) for cell in columns.values())] for key, of in groups.items()]
    return Grid([*names, *columns], lines)


def counted(holds: Callable[[Any], int]) -> Cell:
    """For how many rows something holds; or the sum of whole numbers."""
    return lambda rows: sum(map(holds, rows))


def total(figure: Callable[[Any], float | None]) -> Cell:
    """A sum over the rows that have a figure."""
    return lambda rows: f"{sum(figure(row) or 0 for row in rows):.1f}"


def spreads(rows: Sequence[R], figures: Mapping[str, Callable[[R], float]], digits: int = 3) -> Grid:
    """For each figure the median over the rows, the 95th percentile and the greatest."""
    lines = []
    for name, figure in figures.items() if rows else ():
        found = [figure(row) for row in rows]
        lines.append([name, *(f"{percentile(found, share):,.{digits}f}" for share in (0.5, 0.95, 1.0))])
    return Grid(["", "median", "95 %", "most"], lines)


def as_markdown(parts: Iterable[Line | Grid]) -> str:
    """Lines as paragraphs, grids as tables."""
    blocks = []
    for part in (each.printable() for each in parts):
        if isinstance(part, Line):
            blocks.append(part.text)
        else:
            rows = [part.header, ["---"] * len(part.header), *part.rows]
            blocks.append("\n".join(f"| {' | '.join(row)} |" for row in rows))
    return "\n\n".join(filter(None, blocks)) + "\n"
