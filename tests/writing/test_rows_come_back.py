"""What is written as CSV, JSON lines or Parquet is read back equal, whichever library writes and reads."""

import sys
from importlib.util import find_spec

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity import UsageError
from serendipity.model.table import Cell, Table
from serendipity.writing.rows import FORMATS, check_installed, written
from tests.writing.reading import parquet, rows_of

COLUMNS: dict[str, type] = {"text": str, "whole": int, "number": float, "flag": bool}
TABLE = Table(
    COLUMNS,
    (
        ("move a b", 1, 0.1, True),
        (None, None, None, None),
        ('ü, "quoted" ; =x', -3, 1e-300, False),
        ("=1+1", 2**40, 2, True),
    ),
)
EMPTY = {"no row": Table(COLUMNS, ()), "no cell": Table(COLUMNS, ((None,) * 4, (None,) * 4))}

_TEXTS = st.text(st.characters(codec="utf-8", exclude_characters="\r\x00"), min_size=1)
_CELLS = st.tuples(
    st.none() | _TEXTS.filter(lambda text: not text.startswith("'")),
    st.none() | st.integers(-(2**63), 2**63 - 1),
    st.none() | st.floats(allow_nan=False, allow_infinity=False),
    st.none() | st.booleans(),
)


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("table", [TABLE, *EMPTY.values()], ids=["cells", *EMPTY])
def test_rows_come_back(form: str, table: Table) -> None:
    if form == "parquet":
        parquet_or_skip()
    assert rows_of(written(table, form), form, table) == list(table.rows)


@given(rows=st.lists(_CELLS, max_size=5))
@pytest.mark.parametrize("form", ["csv", "jsonl"])
def test_any_rows_come_back(form: str, rows: list[tuple[Cell, ...]]) -> None:
    table = Table(COLUMNS, tuple(rows))
    assert rows_of(written(table, form), form, table) == rows


def test_hidden_characters_are_escaped_in_json_lines() -> None:
    table = Table({"name": str}, (("a\u202eb\u2028",),))
    assert written(table, "jsonl") == '{"name": "a\\u202eb\\u2028"}\n'


@pytest.mark.parametrize("absent", ["polars", "pyarrow"])
def test_either_library_writes_the_same_parquet(absent: str, monkeypatch: pytest.MonkeyPatch) -> None:
    other = {"polars": "pyarrow", "pyarrow": "polars"}[absent]
    if find_spec(other) is None:
        pytest.skip(f"{other} is not installed")
    monkeypatch.setitem(sys.modules, absent, None)
    content = written(TABLE, "parquet")
    assert isinstance(content, bytes)
    monkeypatch.undo()
    assert [tuple(row.values()) for row in parquet(content)] == list(TABLE.rows)


def test_parquet_without_a_library_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("polars", "pyarrow"):
        monkeypatch.setitem(sys.modules, name, None)
    for form in ("csv", "jsonl"):
        check_installed(form)
    for refused in (lambda: check_installed("parquet"), lambda: written(TABLE, "parquet")):
        with pytest.raises(UsageError, match=r"^Parquet needs polars or pyarrow: install .*\[data\]$"):
            refused()


def parquet_or_skip() -> None:
    try:
        check_installed("parquet")
    except UsageError as error:
        pytest.skip(str(error))
