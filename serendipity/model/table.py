"""Tables of plain values with typed columns, and the data frames that other libraries make of them."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from importlib.util import find_spec
from typing import Any, Final, get_args, get_type_hints

from serendipity.model.errors import UsageError

Cell = str | int | float | bool | None
"""A cell of a table; None where it is empty."""

LIBRARIES: Final = ("pandas", "polars")
"""The libraries of data frames, the one that is asked first in front."""

_PANDAS: Final = {str: "string", int: "Int64", float: "Float64", bool: "boolean"}
"""Types of columns in which a cell may be empty."""


@dataclass(frozen=True, slots=True, repr=False)
class Table:
    """Rows of plain values.

    Attributes:
        columns: name and type (``str``, ``int``, ``float`` or ``bool``) of each; cells of any may be None.
        rows: cells in the order of the columns.
    """

    columns: Mapping[str, type]
    rows: tuple[tuple[Cell, ...], ...]

    def __repr__(self) -> str:
        return f"Table({len(self.rows)} rows, {len(self.columns)} columns)"

    def typed(self) -> dict[str, list[Cell]]:
        """The cells of each column, in its type also where a whole number stands for a float."""
        return {
            name: [None if row[i] is None else kind(row[i]) for row in self.rows]
            for i, (name, kind) in enumerate(self.columns.items())
        }


def columns_of(row: type) -> dict[str, type]:
    """The columns that the fields of a dataclass make: those that hold one plain value, or None."""
    hints = get_type_hints(row)
    kinds = {field.name: _kind(hints[field.name]) for field in fields(row)}
    return {name: kind for name, kind in kinds.items() if kind is not None}


def table_of(row: type, objects: Iterable[object]) -> Table:
    """A table of objects of a dataclass, one a row, a column for each field that holds one plain value."""
    columns = columns_of(row)
    return Table(columns, tuple(tuple(getattr(each, name) for name in columns) for each in objects))


def _kind(hint: Any) -> type | None:
    kinds = [kind for kind in get_args(hint) or (hint,) if kind is not type(None)]
    return kinds[0] if len(kinds) == 1 and kinds[0] in _PANDAS else None


class Tabular(ABC):
    """An object that is a table, too."""

    __slots__ = ()

    @abstractmethod
    def table(self) -> Table:
        """The rows, under names of columns that stay."""

    def to_dataframe(self, library: str | None = None) -> Any:
        """The rows as a data frame, whose library is imported now and not before.

        Args:
            library: ``"pandas"`` or ``"polars"``; None: the first of them that is installed.

        Raises:
            UsageError: there is no such library, or it is not installed.
        """
        return _FRAMES[_installed(library)](self.table())


def _installed(library: str | None) -> str:
    if library is not None and library not in LIBRARIES:
        raise UsageError(f"library: expected one of {', '.join(LIBRARIES)}, got {library!r:.50}")
    wanted = LIBRARIES if library is None else (library,)
    found = next((name for name in wanted if find_spec(name) is not None), None)
    if found is None:
        more = ": install serendipity-planner[data]" if "polars" in wanted else ""
        raise UsageError(f"data frames need {' or '.join(wanted)}{more}")
    return found


def _pandas(table: Table) -> Any:
    import pandas

    columns = table.typed()
    return pandas.DataFrame(
        {name: pandas.Series(columns[name], dtype=_PANDAS[kind]) for name, kind in table.columns.items()}
    )


def polars_frame(table: Table) -> Any:
    """The rows as a data frame of polars."""
    import polars

    kinds = {str: polars.String, int: polars.Int64, float: polars.Float64, bool: polars.Boolean}
    schema = {name: kinds[kind] for name, kind in table.columns.items()}
    return polars.DataFrame(table.typed(), schema=schema)


_FRAMES: Final = {"pandas": _pandas, "polars": polars_frame}
