"""Files of rows read back, by what others read them with."""

import csv
import io
import json
from importlib.util import find_spec
from typing import Any

import pytest

from serendipity.model.table import Cell, Table

_OF_TEXT = {str: str, int: int, float: float, bool: "True".__eq__}


def rows_of(content: str | bytes, form: str, table: Table) -> list[tuple[Cell, ...]]:
    """The rows of a file in the types of a table's columns; skips where nothing here reads the format."""
    if form == "csv":
        header, *lines = csv.reader(io.StringIO(str(content)))
        assert header == list(table.columns)
        return [tuple(map(_cell, line, table.columns.values())) for line in lines]
    if form == "jsonl":
        objects = [json.loads(line) for line in str(content).splitlines()]
    else:
        assert isinstance(content, bytes)
        objects = parquet(content)
    assert all(list(each) == list(table.columns) for each in objects)
    return [tuple(each.values()) for each in objects]


def parquet(content: bytes) -> list[dict[str, Any]]:
    if find_spec("polars") is not None:
        import polars

        return polars.read_parquet(io.BytesIO(content)).to_dicts()
    if find_spec("pyarrow") is not None:
        from pyarrow.parquet import read_table

        rows: list[dict[str, Any]] = read_table(io.BytesIO(content)).to_pylist()
        return rows
    pytest.skip("neither polars nor pyarrow is installed, so nothing here reads Parquet")


def _cell(text: str, kind: type) -> Cell:
    plain = text.removeprefix("'") if kind is str else text  # kept from being computed
    return None if not text else _OF_TEXT[kind](plain)  # type: ignore[return-value]
