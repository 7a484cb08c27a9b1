"""Cross-checked calls in time."""

from pathlib import Path

import pytest

import serendipity
from serendipity.testing.crosscheck import JUDGES, compare
from serendipity.testing.generator import PlanCall, random_call_in_time
from serendipity.testing.written_case import PLAN, write_case
from tests.cli.conftest import Runs, assert_one_line


@pytest.mark.long
def test_search_and_programs_agree() -> None:
    judges = {name: JUDGES[name] for name in ("search", "automata")}
    calls = [random_call_in_time(seed) for seed in range(60)]
    assert all(call == random_call_in_time(call.seed or 0) for call in calls[:5])
    assert sum(call.task.needs_time for call in calls) > 50 and any(call.human_plan for call in calls)
    for call in calls:
        assert compare(call, judges, {}, time_limit=30) is None


def test_a_plan_that_comes_too_late_is_refused_by_all() -> None:
    """The programs answered beside such a plan as if it were none."""
    judges = {name: JUDGES[name] for name in ("search", "automata")}
    assert compare(random_call_in_time(63), judges, {}) is None


def test_one_that_answers_otherwise_is_told_and_written(tmp_path: Path) -> None:
    call = next(c for c in map(random_call_in_time, range(100)) if c.human_plan)

    def wrong(_call: PlanCall, _deadline: serendipity.Deadline) -> serendipity.Result:
        return serendipity.Result("serendipity", "infeasible", "hum", serendipity.Options())

    found = compare(call, {"search": JUDGES["search"], "wrong": wrong}, {})
    assert found is not None
    commands = write_case(found, tmp_path / "case", again="serendipity crosscheck --in-time")
    assert "crosscheck --in-time" in commands.read_text()
    folder = tmp_path / "case"
    task = serendipity.load(folder, human="hum")
    assert task.needs_time == call.task.needs_time and ": (" in (folder / PLAN).read_text()


def test_the_command(run: Runs) -> None:
    told = run("crosscheck --in-time --count 4 --seed 1")
    assert (told.code, told.out) == (0, "4 calls, search, automata: 0 disagreements\n")
    assert_one_line(run("crosscheck --in-time --judges false-certificates"), "knows no time")
