"""Each contender on each call of a suite: what is asked, what is proved, tables, CSV.

The composite task as one problem for outside planners: its optimum is composite mode's without a horizon.
"""

import tempfile
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from search import PreparedTask
from serendipity import InputError, Task, UsageError, example, load_agents, plan
from serendipity.classical import fast_downward
from serendipity.evaluation.benchmark import coverage as report
from serendipity.evaluation.benchmark import side_by_side
from serendipity.evaluation.benchmark.contenders import Contender, Outcome
from serendipity.evaluation.benchmark.coverage import CONTENDERS, MODES, Call, measure
from serendipity.evaluation.benchmark.rows import BenchRow, as_table, disagreements, read_rows
from serendipity.evaluation.measuring.suites import Roles, problems
from serendipity.model import Options
from serendipity.model.telling import Grid
from serendipity.pddl.write import composite_files
from serendipity.writing.rows import written
from serendipity_testing.strategies import tasks


def row(
    task: str, contender: str = "search", status: str = "optimal", cost: float | None = 1.0, **more: object
) -> BenchRow:
    known = {"mode": "composite-inf", "domain": "d", "lower_bound": cost if status == "optimal" else None}
    known |= more
    of_row = {name: known.pop(name) for name in ("mode", "domain")}
    outcome = Outcome(status, cost, **known)  # type: ignore[arg-type]
    return BenchRow(
        **of_row,  # type: ignore[arg-type]
        task=task,
        human="h",
        robots="r1 r2",
        alone=True,
        discount=0.9,
        contender=contender,
        outcome=outcome,
    )


def cells(grid: Grid, first: str) -> dict[str, str]:
    """A row of a table by its headings."""
    return next(dict(zip(grid.header, row, strict=True)) for row in grid.rows if row[0] == first)


@pytest.mark.long
def test_the_search_answers_each_mode_as_plan_does(suite: Path) -> None:
    rows = list(measure(problems(suite, ["flights"]), MODES, ["search"], time_limit=20))
    assert [row.mode for row in rows] == list(MODES)
    for row in rows:
        result = plan(example("flights"), discount="0.9", **MODES[row.mode])
        assert (row.outcome.status, row.outcome.cost) == ("optimal", result.cost)
        assert (row.human, row.robots, row.alone) == ("ada", "kite", True)
        assert row.outcome.lower_bound == result.lower_bound
        assert row.outcome.plan_seconds is not None
        assert 0 < row.outcome.plan_seconds <= row.outcome.seconds < row.outcome.process_seconds


def test_where_nobody_can_alone_only_what_needs_no_plan_is_asked(
    suite: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(CONTENDERS, "nobody", Contender(lambda _: Outcome("unknown")))
    monkeypatch.setattr("serendipity.evaluation.benchmark.coverage.can_alone", lambda *_: False)
    rows = measure(problems(suite, ["flights"]), MODES, ["nobody"])
    assert [row.mode for row in rows] == ["individual", "composite-inf"]


def test_a_call_that_fails_does_not_end_the_run(suite: Path) -> None:
    problem = replace(problems(suite)[0], problem_file=Path("nowhere.pddl"))
    call = Call(problem, Roles("ada", ("kite",)), "individual", 0, 5)  # type: ignore[arg-type]
    outcome = CONTENDERS["search"].answer(call)
    assert outcome.status == "failed"
    assert "nowhere.pddl: there is no such file" in outcome.reason


@pytest.mark.skipif(fast_downward.absent() is not None, reason=fast_downward.absent() or "")
def test_all_contenders_prove_the_same(suite: Path) -> None:
    present = [name for name, contender in CONTENDERS.items() if contender.absent() is None]
    rows = list(measure(problems(suite), ["individual", "composite-inf"], present))
    assert len(rows) == 3 * 2 * len(present)
    assert all(row.outcome.proved for row in rows)
    assert list(disagreements(rows)) == []


def test_what_can_not_all_be_true_is_told() -> None:
    (told,) = disagreements([row("t"), row("t", "other", cost=2.0), row("u"), row("u", "other")])
    assert told == "d t, composite-inf at 0.9: the proved optima differ: search 1.0, other 2.0"
    (told,) = disagreements([row("t"), row("t", "other", "infeasible", None)])
    assert told.endswith("search 1.0, other no plan")
    (told,) = disagreements([row("t"), row("t", "other", "unknown", None, lower_bound=1.5)])
    assert told.endswith("a plan of search costs 1.0, and other says at least 1.5")
    assert not list(disagreements([row("t"), row("t", "other", "feasible", 3.0, lower_bound=0.5)]))


def test_unknown_names_are_refused(suite: Path) -> None:
    for modes, contenders in ((["composite"], ["search"]), (["individual"], ["automata"])):
        with pytest.raises(UsageError, match="for a suite of domains"):
            next(measure(problems(suite), modes, contenders))


ROWS = [
    row("a", seconds=0.05, plan_seconds=0.01, expanded=10, memory=20.0),
    row("b", seconds=3.0, plan_seconds=0.5, expanded=30, memory=40.0),
    row("c", status="feasible", seconds=20.0, plan_seconds=1.5, expanded=1000),
    row("a", "other", seconds=0.5, plan_seconds=0.5, expanded=4),
    row("b", "other", "unknown", None, seconds=20.0),
    row("c", "other", "infeasible", None, seconds=0.2, expanded=7),
    row("a", domain="e", status="failed", cost=None, reason="no such thing"),
]


def test_decided_calls_are_counted_by_domain() -> None:
    grid = report.decided(ROWS)
    assert cells(grid, "d") == {"domain": "d", "tasks": "3", "human's plan": "3", "composite-inf": "2 / 2"}
    assert cells(grid, "all")["tasks"] == "4"


def test_expansions_are_compared_where_both_have_decided() -> None:
    assert cells(report.expansions(ROWS), "d")["composite-inf: search : other"] == "10 : 4 (1)"
    assert cells(report.expansions(ROWS), "e")["composite-inf: search : other"] == "-"


def test_a_call_without_a_proof_takes_longer_than_any_other() -> None:
    assert cells(report.seconds(ROWS), "d")["composite-inf"] == "3 / 0.5"
    assert cells(report.seconds(ROWS[1:3]), "d")["composite-inf"] == "-"


def test_coverage_grows_with_time() -> None:
    grid = report.over_time(ROWS)
    assert grid.header[3:] == ("", "0.1 s", "1 s", "2 s", "5 s", "20 s", "most MiB")
    assert grid.rows[0] == ("composite-inf", "search", "4", "decided", "1", "1", "1", "2", "2", "40")
    assert grid.rows[1][3:] == ("a plan", "1", "2", "3", "3", "3", "")


def test_failures_are_told_with_their_reason() -> None:
    assert report.failures(ROWS) == ["search fails on e a, composite-inf: no such thing"]


def test_rows_are_read_as_they_were_written(tmp_path: Path) -> None:
    file = tmp_path / "rows.csv"
    text = written(as_table(ROWS), "csv")
    file.write_text(text + text)
    assert read_rows(file) == ROWS + ROWS
    for wrong in ("a,b\n", text.replace("0.05", "soon"), "", text.splitlines()[0], "a" * 200_000):
        file.write_text(wrong)
        with pytest.raises(InputError, match=r"expected (a row|rows) that"):
            read_rows(file)


DISCOUNTS = ("0", "0.5", "0.9")


def read_back(task: Task, discount: Fraction) -> tuple[Task, int]:
    """The task of one agent that the files describe, and the scale of its costs."""
    files = composite_files(task, discount)
    with tempfile.TemporaryDirectory() as folder:
        pair = Path(folder, "domain.pddl"), Path(folder, "problem.pddl")
        for path, text in zip(pair, (files.domain, files.problem), strict=True):
            path.write_text(text)
        return load_agents({"everybody": pair}, human="everybody"), files.scale


@given(tasks(), st.sampled_from(DISCOUNTS))
@settings(max_examples=60)
def test_one_agent_pays_what_the_team_pays(task: Task, discount: str) -> None:
    """With strict interference every epoch's actions can be done one after another."""
    team = plan(task, mode="composite", horizon="inf", discount=discount, interference="strict")
    alone, scale = read_back(task, Fraction(discount))
    answer = plan(alone, mode="individual")
    assert (answer.status == "infeasible") == (team.status == "infeasible")
    if team.cost is not None:
        assert answer.cost == pytest.approx(team.cost * scale)
    assert all(action.cost.denominator == 1 for action in alone.actions)


@pytest.mark.skipif(fast_downward.absent() is not None, reason=fast_downward.absent() or "")
@pytest.mark.parametrize("name", ["room2", "room5", "room7"])
def test_fast_downward_finds_the_same_cost(name: str) -> None:
    task = example(name)
    options = Options(mode="composite", horizon="inf", discount=Fraction("0.9"))
    answer = side_by_side.CONTENDERS["fast-downward"].answer(PreparedTask(task), options)
    assert answer.status == "optimal"
    assert answer.cost == plan(task, mode="composite", horizon="inf", discount="0.9").cost
    assert answer.process_seconds is not None and answer.process_seconds > answer.seconds > 0
    assert answer.memory is not None and answer.memory > 1
