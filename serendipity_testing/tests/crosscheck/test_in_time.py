"""Cross-checked calls in time."""

from fractions import Fraction
from itertools import islice
from pathlib import Path

import pytest

import serendipity
from serendipity_testing.crosscheck import JUDGES, FalseCertificates, compare
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.generator import PlanCall, random_call_in_time
from serendipity_testing.oracle import truth
from serendipity_testing.oracle.reactions import LeastCost
from serendipity_testing.tests.crosscheck.test_among_people import BOTH
from serendipity_testing.written_case import PLAN, write_case
from tests.cli.conftest import Runs


@pytest.mark.long
def test_search_and_programs_agree() -> None:
    calls = [random_call_in_time(seed) for seed in range(60)]
    assert all(call == random_call_in_time(call.seed or 0) for call in calls[:5])
    assert sum(call.task.needs_time for call in calls) > 50 and any(call.human_plan for call in calls)
    for call in calls:
        assert compare(call, BOTH, {}, time_limit=30) is None


def test_bystanders_and_people_who_replan_are_drawn() -> None:
    calls = [random_call_in_time(seed) for seed in range(60)]
    beside = [call for call in calls if call.task.script.people]
    replanning = [call for call in calls if "human_model" in call.options]
    assert len(beside) > 4 and len(replanning) > 2
    assert all("--somebody-pays" in call.command_words() for call in beside)


@pytest.mark.long
def test_brute_force_judges_answers_beside_people_who_replan(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = (call for call in map(random_call_in_time, range(300)) if "human_model" in call.options)
    kept = [call for call in islice(calls, 8) if compare(call, {"search": JUDGES["search"]}, {}) is None]
    assert len(kept) == 8
    monkeypatch.setattr(truth, "best_reaction", lambda *_: LeastCost(Fraction(-1), 0))
    said = [compare(call, {"search": JUDGES["search"]}, {}) for call in kept]
    assert any(found is not None and "brute force" in found.said for found in said)


def test_given_plans_disturb_nobody() -> None:
    """A bystander was disturbed by a given plan where interference is strict: each judge refused the call."""
    call = random_call_in_time(882_536)
    assert call.task.script.people and call.options["interference"] == "strict"
    assert compare(call, {"search": JUDGES["search"]}, {}) is None


def test_what_is_beside_bystanders_is_told_by_its_seed(tmp_path: Path) -> None:
    call = next(call for call in map(random_call_in_time, range(100)) if call.task.script.people)
    commands = write_case(Disagreement(call, {}), tmp_path / "case", again="serendipity crosscheck --in-time")
    assert commands.read_text().endswith("serendipity crosscheck --in-time\n")
    assert not [*(tmp_path / "case").glob("*/*.pddl")]


@pytest.mark.long
def test_no_false_certificate_in_time() -> None:
    judge = FalseCertificates()
    calls = map(random_call_in_time, range(40))
    for call in islice(calls, 6):
        assert judge(call) is None
    kinds, _, _, verdicts = (set(part) for part in zip(*judge.counts, strict=True))
    assert {"other durations", "another script", "another head start"} <= kinds
    assert "refuted" in verdicts


def test_a_plan_that_comes_too_late_is_refused_by_all() -> None:
    """The programs answered beside such a plan as if it were none."""
    assert compare(random_call_in_time(63), BOTH, {}) is None


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
