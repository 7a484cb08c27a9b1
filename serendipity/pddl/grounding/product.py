"""Bindings as a product of tables: what varies independently is kept apart.

A literal that has only some of the variables stands for few ground atoms, however many
bindings there are: each is made once and then looked up.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import repeat
from math import prod
from typing import NamedTuple

Row = tuple[str, ...]
"""Values of some variables."""

Part = tuple[int, ...]
"""Numbers of some tables of a product, ascending."""


class Bindings(NamedTuple):
    """Values of some variables that depend on each other: a row for each choice."""

    variables: tuple[str, ...]
    rows: list[Row]


def combined(tables: Iterable[Bindings]) -> tuple[tuple[str, ...], Iterable[Row]]:
    """The variables of several tables, and all combinations of their rows, made one by one."""
    variables: tuple[str, ...] = ()
    rows: Iterable[Row] = [()]
    for table in tables:
        variables += table.variables
        rows = _each_with(rows, table.rows)
    return variables, rows


def _each_with(rows: Iterable[Row], others: list[Row]) -> Iterator[Row]:
    return (row + other for row in rows for other in others)


class Product:
    """Every binding of some variables: a row of each table, freely combined.

    Bindings are in the order in which the last table varies fastest.  Those of a part
    of the tables are numbered likewise.

    Attributes:
        everything: all tables that leave a choice.
        fixed: values of the variables that are in none of those.
    """

    def __init__(self, tables: Sequence[Bindings]) -> None:
        self._tables = tables
        self.size = prod([len(table.rows) for table in tables])
        self._sizes: list[int] = []
        self._home: dict[str, int] = {}  # of a variable with a choice: the number of its table
        self._columns: dict[str, list[str]] = {}
        self.fixed: dict[str, str] = {}
        self._indices: dict[tuple[Part, Part], Sequence[int]] = {}
        for variables, rows in tables:
            if len(rows) == 1:
                self.fixed.update(zip(variables, rows[0], strict=True))
            else:
                self._home.update(dict.fromkeys(variables, len(self._sizes)))
                self._columns.update({v: [row[i] for row in rows] for i, v in enumerate(variables)})
                self._sizes.append(len(rows))
        self.everything: Part = tuple(range(len(self._sizes)))

    def __iter__(self) -> Iterator[dict[str, str]]:
        """The values of all variables, binding by binding."""
        names = [*self.fixed, *self._home]
        columns = [self.column(name, self.everything) for name in names]
        for _, *values in zip(range(self.size), *columns, strict=True):
            yield dict(zip(names, values, strict=True))

    def slices(self, most: int) -> Iterator["Product"]:
        """The same bindings in the same order, at most so many at a time."""
        if self.size <= most:
            yield self
            return
        first = next(n for n, table in enumerate(self._tables) if len(table.rows) > 1)
        variables, rows = self._tables[first]
        step = max(1, most * len(rows) // self.size)
        for start in range(0, len(rows), step):
            part = Bindings(variables, rows[start : start + step])
            yield from Product([*self._tables[:first], part, *self._tables[first + 1 :]]).slices(most)

    def part(self, terms: Iterable[str]) -> Part:
        """The tables on which the values of some terms depend."""
        return tuple(sorted({self._home[term] for term in terms if term in self._home}))

    def column(self, term: str, part: Part) -> Iterable[str]:
        """The values of a term, for each binding of a part that it depends on."""
        if term in self._home:
            return map(self._columns[term].__getitem__, self.index((self._home[term],), part))
        return repeat(self.fixed.get(term, term), prod([self._sizes[n] for n in part]))

    def index(self, part: Part, whole: Part) -> Sequence[int]:
        """For each binding of ``whole``, the number of the binding of ``part`` within it."""
        if part == whole:
            return range(prod([self._sizes[n] for n in whole]))
        index = self._indices.get((part, whole))
        if index is None:
            index = [0]
            for n in whole:
                size = self._sizes[n]
                if n in part:
                    index = [i * size + j for i in index for j in range(size)]
                else:
                    index = [i for i in index for _ in range(size)]
            self._indices[part, whole] = index
        return index
