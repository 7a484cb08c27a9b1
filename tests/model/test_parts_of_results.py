"""What results say beside their plan: typed in Python, in ``statistics`` in JSON, and kept if malformed.

Certificates, whose verdict follows from their claims; and values as data frames of pandas or polars.
"""

import json
import sys
from copy import deepcopy
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec
from typing import Any

import pytest

import serendipity
from serendipity import Result, Task
from serendipity.execution import Run
from serendipity.model import Certificate, Claim, PlanStep, UsageError
from serendipity.model.answers.result import closing
from serendipity.model.table import LIBRARIES, Table, Tabular, columns_of, table_of
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_4, case_5

PARTS = ("gap", "ties", "optimal_plans", "bounds", "recognition", "goals")


def rivals() -> Task:
    """Lifting helps with p, and costs nothing with z."""
    actions = {
        "do1 h": "-> p @ 9",
        "do2 h": "q -> p @ 1",
        "lift r": "-> q @ 0",
        "keep h": "!q -> z @ 5",
        "mend h": "q -> z @ 5",
    }
    return build(goal="p", actions=actions)


def for_goals(**options: Any) -> Result:
    goals = [{"name": "p", "goal": ["p"], "prior": "1/3"}, {"name": "z", "goal": ["z"], "prior": "2/3"}]
    return serendipity.plan(rivals(), goals=goals, horizon=3, **options)


def examples() -> dict[str, tuple[Task, Result]]:
    return {
        "ties": (case_4(), serendipity.plan(case_4(), discount="0.9", ties="expected")),
        "bounds": (case_5(), serendipity.plan(case_5(), mode="assistance")),
        "goals": (rivals(), for_goals()),
    }


@pytest.mark.parametrize("name", ["ties", "bounds", "goals"])
def test_files_say_the_same(name: str) -> None:
    _, result = examples()[name]
    data = json.loads(json.dumps(result.to_dict()))
    read = Result.from_dict(data)
    assert not set(PARTS) & result.statistics.keys()
    assert read.statistics == result.statistics
    assert not read.malformed
    assert read.to_dict() == data
    assert getattr(read, name) is not None
    for part in PARTS:
        assert read.says(part) == (part in data["statistics"]) == (getattr(result, part) is not None)


def test_exact_where_it_is_written_exactly() -> None:
    result = for_goals()
    assert [goal.prior for goal in result.recognition.goals] == [Fraction(1, 3), Fraction(2, 3)]
    read = Result.from_dict(result.to_dict())
    assert [float(goal.prior) for goal in read.recognition.goals] == [1 / 3, 2 / 3]
    assert (read.ties, read.goals) == (result.ties, result.goals)


@pytest.mark.parametrize("value", [None, 7, "x", [7], {"a": 7}, 10**400, [{"cost": 10**400}]])
@pytest.mark.parametrize(("name", "part"), [("ties", "ties"), ("bounds", "bounds"), ("goals", "goals")])
def test_a_malformed_part_stays_and_is_refuted(name: str, part: str, value: object) -> None:
    task, result = examples()[name]
    data = deepcopy(result.to_dict())
    data["statistics"][part] = value
    read = Result.from_dict(data)
    assert (getattr(read, part), read.statistics[part]) == (None, value)
    assert part in read.malformed[part]
    assert read.to_dict() == data
    refuted = serendipity.verify(task, read).refuted
    assert refuted.reason.endswith(read.malformed[part])


@pytest.mark.parametrize("field", ["probability", "cost"])
def test_numbers_without_a_float_are_refuted(field: str) -> None:
    """They ended the verifier with a traceback."""
    data = for_goals().to_dict()
    data["statistics"]["goals"][0][field] = 10**400
    refuted = serendipity.verify(rivals(), Result.from_dict(data)).refuted
    assert field in refuted.reason


@pytest.mark.parametrize("part", ["gap", "optimal_plans"])
def test_what_carries_no_claim_is_not_refuted(part: str) -> None:
    task, result = examples()["ties"]
    data = result.to_dict()
    data["statistics"] |= {part: "x", "more": [1]}
    read = Result.from_dict(data)
    assert (read.statistics[part], read.statistics["more"]) == ("x", [1])
    assert serendipity.verify(task, read).verdict == "proved"


def test_parts_that_somebody_put_into_statistics_by_hand() -> None:
    task, result = examples()["ties"]
    old = replace(result, ties=None, statistics=result.to_dict()["statistics"])
    assert old.checked().ties == result.ties
    assert serendipity.verify(task, old).verdict == "proved"


def test_plans_are_counted_apart_from_those_that_were_looked_at() -> None:
    """The first of two answers costs as much as doing nothing, and so is the dearest."""
    about = build(goal="g", actions={"a h": " -> g @ 1", "b h": " -> g @ 1", "c r": " -> q @ 1"})
    said = [*closing(serendipity.plan(about, ties="robust"))]
    assert said[0] == "2 optimal plans of the human, 1 looked at, an opportunity with 0 (robust)"


def test_what_is_no_object_is_called_as_in_json() -> None:
    for given, called in (
        (None, "null"),
        ([], "a list"),
        (3, "a number"),
        ("x", "a text"),
        (True, "true or"),
    ):
        with pytest.raises(serendipity.InputError, match=f"expected a JSON object, got {called}"):
            Result.from_dict(given)


@pytest.mark.parametrize(
    ("verdicts", "whole"),
    [
        ((), "undecided"),
        (("not_in_scope",), "undecided"),
        (("proved", "not_in_scope"), "proved"),
        (("proved", "undecided"), "undecided"),
        (("undecided", "refuted", "proved"), "refuted"),
    ],
)
def test_the_whole_is_as_good_as_its_worst_claim(verdicts: tuple[str, ...], whole: str) -> None:
    claims = tuple(Claim("cost", verdict, "because") for verdict in verdicts)
    certificate = Certificate(claims, 0.1)
    assert certificate.verdict == whole
    assert (certificate.refuted is not None) == (whole == "refuted")


@pytest.mark.parametrize(("claim", "verdict"), [("beauty", "proved"), ("cost", "maybe")])
def test_unknown_words_are_refused(claim: str, verdict: str) -> None:
    with pytest.raises(UsageError, match="expected one of"):
        Claim(claim, verdict, "because")


def test_json_has_the_documented_fields() -> None:
    step = PlanStep(1, ("h", "r"), "lift h r", 2.0)
    claim = Claim("optimal", "refuted", "cheaper", (step,), 0.2, 1.5, "program", {"columns": 3, "rows": 2}, 1)
    written = Certificate((claim,), 0.3, "S 1", "E", solver_calls=1).to_dict()
    assert json.loads(json.dumps(written)) == {
        "schema": "serendipity.certificate/1",
        "verdict": "refuted",
        "claims": [
            {
                "claim": "optimal",
                "verdict": "refuted",
                "reason": "cheaper",
                "counterexample": [{"epoch": 1, "agents": ["h", "r"], "action": "lift h r", "cost": 2.0}],
                "seconds": 0.2,
                "bound": 1.5,
                "method": "program",
                "size": {"columns": 3, "rows": 2},
                "solver_calls": 1,
            }
        ],
        "solver": "S 1",
        "encoding": "E",
        "size": {},
        "solver_calls": 1,
        "elapsed_seconds": 0.3,
    }


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
