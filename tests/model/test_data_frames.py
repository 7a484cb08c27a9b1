"""Values as data frames of pandas or polars: typed columns, one line where neither is there."""

import sys
from importlib.util import find_spec
from typing import Any

import pytest

import serendipity
from serendipity import UsageError
from serendipity.execution import Run
from serendipity.model.table import LIBRARIES, Table, Tabular, columns_of, table_of


def rows_of(frame: Any) -> list[dict[str, Any]]:
    if hasattr(frame, "to_dicts"):
        return list(frame.to_dicts())
    rows = frame.astype(object).where(frame.notna(), None).to_dict("records")
    return list(rows)


class Shown(Tabular):
    def table(self) -> Table:
        return Table({"name": str, "n": int, "x": float, "b": bool}, (("a", 1, 2, True), (None,) * 4))


@pytest.mark.parametrize("library", LIBRARIES)
def test_columns_keep_their_types_where_cells_are_empty(library: str) -> None:
    pytest.importorskip(library)
    frame = Shown().to_dataframe(library)
    assert type(frame).__module__.split(".")[0] == library
    first, second = rows_of(frame)
    assert first == {"name": "a", "n": 1, "x": 2.0, "b": True} and set(second.values()) == {None}
    kinds = [str(kind) for kind in frame.dtypes]
    assert kinds in (["string", "Int64", "Float64", "boolean"], ["String", "Int64", "Float64", "Boolean"])


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_plan_has_a_row_a_step(library: str) -> None:
    pytest.importorskip(library)
    result = serendipity.plan(serendipity.example("room2"), discount=0.6)
    rows = rows_of(result.to_dataframe(library))
    assert rows == [
        {"epoch": s.epoch, "agents": ", ".join(s.agents), "action": s.action, "cost": s.cost, "duration": 1}
        for s in result.plan
    ]
    assert sum(row["cost"] for row in rows) == pytest.approx(12.6)
    nothing = serendipity.Result("serendipity", "unknown", "commx", result.options).to_dataframe(library)
    assert list(nothing.columns) == ["epoch", "agents", "action", "cost", "duration"] and len(nothing) == 0


def test_an_execution_has_a_row_an_epoch() -> None:
    run = serendipity.Execution(serendipity.example("room2"), discount=0.6)
    for name in (None, "move commx room13 hall8"):
        run.step(name)
    first, second = (dict(zip(run.table().columns, row, strict=True)) for row in run.table().rows)
    assert (first["epoch"], first["human"], first["human_cost"]) == (1, None, 0.0)
    assert (second["human"], second["human_cost"]) == ("move commx room13 hall8", 1.0)
    assert str(second["steps"]).split("; ")[0] == "move commx room13 hall8"
    for row, passed in zip((first, second), run.passed, strict=True):
        assert (row["verdict"], row["reason"]) == (passed.decided.verdict, passed.decided.reason)


def test_whichever_library_is_there_is_taken() -> None:
    there = [name for name in LIBRARIES if find_spec(name) is not None]
    if not there:
        pytest.skip("neither pandas nor polars is installed")
    assert type(Shown().to_dataframe()).__module__.split(".")[0] == there[0]


def test_without_a_library_there_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in LIBRARIES:
        monkeypatch.setitem(sys.modules, name, None)
    hint = r"^data frames need pandas or polars: install serendipity-planner\[data\]$"
    with pytest.raises(UsageError, match=hint):
        Shown().to_dataframe()
    with pytest.raises(UsageError, match=r"^data frames need pandas$"):
        Shown().to_dataframe("pandas")
    with pytest.raises(UsageError, match=r"^library: expected one of pandas, polars, got 'excel'"):
        Shown().to_dataframe("excel")


def test_columns_are_the_fields_that_hold_one_value() -> None:
    assert columns_of(serendipity.PlanStep) == {"epoch": int, "action": str, "cost": float, "duration": int}
    assert columns_of(Run)["alone"] is float and columns_of(Run)["reached"] is bool
    step = serendipity.PlanStep(2, ("a",), "move a", 1.0)
    assert table_of(serendipity.PlanStep, [step]).rows == ((2, "move a", 1.0, 1),)
