"""Judges from outside: what they may claim, what refutes it, how they are named."""

import json
import re
import shlex
import sys
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

import serendipity
from serendipity import Deadline, Task
from serendipity_testing.builders import task as build
from serendipity_testing.crosscheck import JUDGES, compare, shows_it_too
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.generator.calls import PlanCall, random_call
from serendipity_testing.judges import OutsideJudge, Proposal, by_command, by_name
from serendipity_testing.shrinking import shrink
from tests.cli.conftest import Runs, assert_one_line

SEARCH = {"search": JUDGES["search"]}
CALL = PlanCall(
    build(init="a", goal="c", actions={"x h": "a -> b", "y r": "b -> c @ 2", "z h": "a -> c !a @ 5"}),
    {"mode": "composite", "horizon": "inf", "interference": "strict", "discount": "1/2"},
)
X, Y, Z = range(3)
"""x and then y costs 2."""


def judge(claim: Proposal) -> OutsideJudge:
    return OutsideJudge("stranger", lambda *_: claim)


@pytest.mark.parametrize(
    "claim",
    [Proposal("optimal", (X, Y)), Proposal("feasible", (Z,)), Proposal("unknown", words="no memory")],
    ids=lambda claim: claim.status,
)
def test_what_can_be_so_is_no_disagreement(claim: Proposal) -> None:
    assert compare(CALL, SEARCH, outside=[judge(claim)]) is None


@pytest.mark.parametrize(
    ("claim", "why"),
    [
        (Proposal("optimal", (Z,)), "its plan costs 5, where 2 is the least"),
        (Proposal("infeasible"), "there is a plan of cost 2"),
        (Proposal("optimal", (Y,)), "step 1 of its plan, 'y r', is not applicable"),
        (Proposal("optimal", (X,)), "its plan misses a goal"),
        (Proposal("infeasible", (X, Y)), "infeasible, with a plan"),
    ],
)
def test_what_can_not_be_so_is_one(claim: Proposal, why: str) -> None:
    found = compare(CALL, SEARCH, outside=[judge(claim)])
    assert found is not None
    assert why in found.said["stranger"]


def test_a_plan_where_there_is_none_is_one() -> None:
    nothing = PlanCall(build(init="a", goal="b", actions={"x h": "b -> a"}), CALL.options)
    assert compare(nothing, SEARCH, outside=[judge(Proposal("infeasible"))]) is None
    found = compare(nothing, SEARCH, outside=[judge(Proposal("optimal", ()))])
    assert found is not None
    assert "misses a goal" in found.said["stranger"]


def test_who_counts_actions_is_asked_about_actions() -> None:
    call = replace(judge(Proposal("unknown")), unit_costs=True).fitted(CALL)
    assert {action.cost for action in call.task.actions} == {1}
    assert call.options["discount"] == "0"


@pytest.mark.parametrize("seed", range(12))
def test_an_engine_of_the_library_agrees(seed: int) -> None:
    engine = by_name("up:serendipity")
    assert compare(random_call(seed), SEARCH, outside=[engine], time_limit=60) is None


def test_a_shrunk_case_asks_the_same_question() -> None:
    """Without an option it would be another: within the human's epochs no robot could help here."""
    task = build(init="a", goal="c", actions={"x h": "a -> c @ 9", "y r": "a -> b", "z r": "b -> c"})
    call = PlanCall(task, {"mode": "serendipity", "discount": "1/2", "suffix": "subplan"})
    honest = OutsideJudge("stranger", lambda *_: Proposal("optimal", (1, 2)))
    assert compare(call, SEARCH, outside=[honest]) is None
    assert not shows_it_too(Disagreement(call, {}), SEARCH, outside=[honest])(
        replace(call, options={"mode": "composite"})
    )
    lying = judge(Proposal("optimal", (0,)))
    found = compare(call, SEARCH, outside=[lying])
    assert found is not None
    smallest = compare(
        shrink(found.call, shows_it_too(found, SEARCH, outside=[lying])), SEARCH, outside=[lying]
    )
    assert smallest is not None
    assert (smallest.call.options["horizon"], smallest.call.options["interference"]) == ("inf", "strict")


def best(task: Task, discount: Fraction) -> list[str] | None:
    """A judge as somebody would write it."""
    result = serendipity.plan(task, mode="composite", horizon="inf", interference="strict", discount=discount)
    return None if result.plan is None else [step.action for step in result.plan]


def greedy(task: Task, discount: Fraction) -> list[str] | None:
    """One with a bug: robots cost nothing to it."""
    return best(task, Fraction(1))


HERE = "serendipity_testing.tests.crosscheck.test_judges_from_outside"


@pytest.mark.long
def test_a_function_is_asked_and_found_out(run: Runs) -> None:
    asked = "crosscheck --judges search --seed 3 --time-limit 60"
    done = run(f"{asked} --count 5 --judge {HERE}:best")
    assert (done.code, done.out) == (0, f"5 calls, search, {HERE}:best: 0 disagreements\n")
    done = run(f"{asked} --count 100 --judge {HERE}:greedy -o case")
    assert (done.code, "is the least" in done.out) == (1, True)
    folder = Path("case")
    shown = re.search(rf"--seed (\d+) --judge {HERE}:greedy", (folder / "commands.txt").read_text())
    assert shown is not None
    assert "(define (domain grounded)" in (folder / "joint-domain.pddl").read_text()
    task = serendipity.load(folder, human="h" if (folder / "h").exists() else "hum")
    assert len(task.actions) < len(random_call(int(shown[1])).task.actions)


PLANNER = """
import sys
from serendipity.model import InputError
domain, problem, plan = sys.argv[1:]
texts = [open(name).read() for name in (domain, problem)]
assert "total-cost" in texts[0] and "(:goal" in texts[1]
{}
"""


def command(tmp_path: Path, body: str) -> OutsideJudge:
    script = tmp_path / "planner.py"
    script.write_text(PLANNER.format(body))
    return by_command(f"{sys.executable} {script}")


BEST = Proposal("optimal", (X, Y))
NONE = Proposal("infeasible")
NUMBERED = "open(plan + '.1', 'w').write('(z_h)'); open(plan + '.2', 'w').write('0.0: (X_H )\\n1.0: (Y_R)')"


@pytest.mark.parametrize(
    ("body", "claim"),
    [
        pytest.param("open(plan, 'w').write('; found\\n(x_h)\\n(y_r)\\n')", BEST, id="file"),
        pytest.param(NUMBERED, BEST, id="numbered"),
        pytest.param("print('Solution:'); print('(x_h)'); print('(y_r) ; cost 2')", BEST, id="output"),
        ('print(\'{"status": "optimal", "plan": ["x_h", {"action": "y_r"}]}\')', BEST),
        pytest.param("sys.exit(12)", NONE, id="exit code"),
        ("print('{\"plan\": null}')", NONE),
        ('print(\'{"plan": null, "status": "unknown"}\')', Proposal("unknown")),
        pytest.param("open(plan, 'w')", Proposal("optimal", ()), id="empty"),
    ],
)
def test_a_command_is_read(body: str, claim: Proposal, tmp_path: Path) -> None:
    assert command(tmp_path, body).answer(CALL, Deadline()) == claim


@pytest.mark.parametrize(
    ("body", "why"),
    [
        ("sys.exit('out of petrol')", "exit code 1: out of petrol"),
        ("print('(fly h)')", "'fly h', which is no action"),
        ("print('{\"status\": 3}')", "JSON can't be read"),
    ],
)
def test_a_command_that_fails_is_a_disagreement(body: str, why: str, tmp_path: Path) -> None:
    stranger = command(tmp_path, body)
    found = compare(CALL, SEARCH, outside=[stranger])
    assert found is not None
    assert why in found.said[stranger.name]


def test_a_command_that_takes_too_long_knows_nothing(tmp_path: Path) -> None:
    claim = command(tmp_path, "import time; time.sleep(60)").answer(CALL, Deadline(0.3))
    assert claim == Proposal("unknown", words="time limit")


def test_places_of_files_are_filled_in(tmp_path: Path) -> None:
    script = tmp_path / "planner.py"
    script.write_text("import json, sys; print(json.dumps({'plan': None, 'status': sys.argv[1][:4]}))")
    judged = by_command(f"{sys.executable} {script} of={{problem}}")
    assert json.dumps(judged.answer(CALL, Deadline()).status) == '"of=/"'


@pytest.mark.parametrize(
    ("make", "name", "why"),
    [
        (by_name, "nowhere", "expected 'package.module:function' or 'up:ENGINE'"),
        (by_name, "no_such_module:f", "No module named"),
        (by_name, "json:f", "has no attribute 'f'"),
        (by_name, "json:__name__", "expected a function, got str"),
        (by_name, "up:deep-thought", "engine 'deep-thought': expected one of"),
        (by_command, "no-such-program -x", "there is no program 'no-such-program'"),
        (by_command, "", "there is no program"),
        (by_command, "  ", "there is no program ''"),
        (by_command, "cat '", "No closing quotation"),
    ],
)
def test_judges_that_are_not_there_are_told(
    make: Callable[[str], OutsideJudge], name: str, why: str, run: Runs
) -> None:
    with pytest.raises(serendipity.UsageError, match=why):
        make(name)
    option = "--judge" if make is by_name else "--judge-command"
    assert_one_line(run(shlex.join(("crosscheck", "--count", "1", option, name))))
