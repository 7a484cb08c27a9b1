"""Tables as files: CSV, JSON lines, Parquet."""

import io
from collections.abc import Callable
from importlib.util import find_spec
from typing import Final

from serendipity.model import Table, UsageError
from serendipity.model.table import polars_frame


def written(table: Table, form: str) -> str | bytes:
    """A table as the content of a file.

    Args:
        form: one of :data:`FORMATS`.

    Raises:
        UsageError: it is ``parquet``, and nothing is installed that writes it.
        ValueError: in JSON lines, a number is not finite.
    """
    return FORMATS[form](table)


def check_installed(form: str) -> None:
    """A UsageError before the work is done, where nothing is installed that writes a format."""
    if form == "parquet":
        _parquet_writer()


def _csv(table: Table) -> str:
    from serendipity.writing.csv_text import as_csv

    return as_csv(list(table.columns), table.rows)


def _json_lines(table: Table) -> str:
    import json

    from serendipity.model.printable import printable_json

    encode = json.JSONEncoder(ensure_ascii=False, allow_nan=False).encode
    lines = (encode(dict(zip(table.columns, row, strict=True))) for row in table.rows)
    return "".join(f"{printable_json(line)}\n" for line in lines)


def _parquet_writer() -> Callable[[Table], bytes]:
    for library, writer in (("polars", _with_polars), ("pyarrow", _with_pyarrow)):
        if find_spec(library) is not None:
            return writer
    raise UsageError("Parquet needs polars or pyarrow: install serendipity-planner[data]")


def _with_polars(table: Table) -> bytes:
    content = io.BytesIO()
    polars_frame(table).write_parquet(content)
    return content.getvalue()


def _with_pyarrow(table: Table) -> bytes:
    import pyarrow
    from pyarrow.parquet import write_table

    kinds = {str: pyarrow.string(), int: pyarrow.int64(), float: pyarrow.float64(), bool: pyarrow.bool_()}
    schema = pyarrow.schema([(name, kinds[kind]) for name, kind in table.columns.items()])
    content = io.BytesIO()
    write_table(pyarrow.table(table.typed(), schema=schema), content)
    return content.getvalue()


FORMATS: Final[dict[str, Callable[[Table], str | bytes]]] = {
    "csv": _csv,
    "jsonl": _json_lines,
    "parquet": lambda table: _parquet_writer()(table),
}
"""By name, which is how such a file's name ends, too."""
