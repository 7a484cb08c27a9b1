"""Smallest cases: of the fault that was found, by halves, in time, with both plans; what hangs is ended."""

import signal
import time
from fractions import Fraction

import pytest

from serendipity import plan
from serendipity.model import Deadline, Task, UsageError
from serendipity_testing import PlanCall, PlannerError, by_function, by_name, check_planner, shrink, task
from serendipity_testing.disagreement import Disagreement

FACTS = [f"f{i}" for i in range(64)]
CALL = PlanCall(
    task(goal="done", actions={"act h": "-> done", **{f"make{f} h": f"-> {f}" for f in FACTS}}), {}
)


def test_halves_are_left_out_first() -> None:
    asked: list[int] = []

    def shows(call: PlanCall) -> bool:
        return {"act h", "makef17 h"} <= {action.name for action in call.task.actions}

    smallest = shrink(CALL, shows, on_try=asked.append)
    assert {action.name for action in smallest.task.actions} == {"act h", "makef17 h"}
    assert asked == list(range(1, len(asked) + 1))
    assert len(asked) < len(FACTS), "one by one it would be at least as many"


STEP = "(refuted: step {} of its plan, '{}', is not applicable)"
DEAR = "optimal, cost 5 (refuted: its plan costs 5, where 4 is the least)"
NO_GOAL = "optimal, cost 5 (refuted: its plan misses a goal)"


@pytest.mark.parametrize(
    ("one", "other", "alike"),
    [
        (DEAR, "infeasible (refuted: there is a plan of cost 2)", True),
        (f"optimal, cost 5 {STEP.format(3, 'a')}", f"optimal, cost 2 {STEP.format(1, 'b c')}", True),
        (NO_GOAL, f"optimal, cost 5 {STEP.format(1, 'b')}", False),
        (NO_GOAL, DEAR, False),
        (NO_GOAL, "UPException: empty goal", False),
        ("raised KeyError: 'a'", "raised KeyError: 7", True),
        ("raised KeyError: 'a'", "raised TypeError: 7", False),
    ],
)
def test_the_kind_of_a_fault(one: str, other: str, alike: bool) -> None:
    known = {"brute force": "optimal, cost 4"}
    kinds = {Disagreement(CALL, {**known, "mine": said}).kind for said in (one, other)}
    assert (len(kinds) == 1) == alike


def drops_the_last(task: Task, discount: Fraction) -> list[str] | None:
    """A planner that forgets its last action, and can't read tasks without robots' actions."""
    best = plan(task, mode="composite", horizon="inf", interference="strict", discount=discount)
    names = None if best.plan is None else [step.action for step in best.plan]
    if not any(task.human not in action.participants for action in task.actions):
        raise ValueError("too small for me")
    return names and names[:-1]


def test_another_fault_does_not_take_the_place_of_the_first() -> None:
    with pytest.raises(PlannerError) as error:
        check_planner(drops_the_last, count=20)
    said = str(error.value)
    assert "misses a goal" in said
    assert "too small for me" not in said
    assert "its plan, cost" in said
    assert "our plan, cost" in said


def hangs(task: Task, discount: Fraction) -> list[str] | None:
    while True:
        try:
            time.sleep(1)
        except Exception:
            continue


@pytest.mark.long
def test_a_planner_that_hangs_is_ended() -> None:
    started = time.monotonic()
    with pytest.raises(PlannerError, match=r"(?s)seed \d+\).*TimeoutError: no answer within 0.2 s"):
        check_planner(hangs, count=3, seed=7, call_limit=0.2)
    assert time.monotonic() - started < 90


def test_somebody_elses_alarm_still_rings() -> None:
    """That of pytest-timeout, say."""
    rung: list[signal.Signals] = []
    before = signal.signal(signal.SIGALRM, lambda *_: rung.append(signal.SIGALRM))
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    try:
        by_function(lambda *_: None).answer(CALL, Deadline(60.0))
        time.sleep(1)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert rung == [signal.SIGALRM]


def test_an_engine_that_is_not_installed_says_how_to() -> None:
    pytest.importorskip("unified_planning", reason="needs the extra 'up'")
    with pytest.raises(UsageError, match="engine 'lpg' is not installed: `pip install up-lpg`"):
        by_name("up:lpg")
