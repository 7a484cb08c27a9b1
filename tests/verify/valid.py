"""Valid results by hand: a task, a plan that keeps every rule, and the figures that follow."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from serendipity.model import Condition, Result, Task
from serendipity_testing.builders import task as build
from serendipity_testing.by_hand import result
from serendipity_testing.cases import case_2, case_4, case_9, case_10

CASE_4_PI_H = (
    "move h a b",
    "move h b c",
    "move h c r",
    "pick_up_medkit h k2 r",
    "move h r c",
    "move h c d",
    "move h d g",
    "conduct_triage h g",
)
CASE_4_HELP = {
    1: "move h a b; pick_up_medkit rob k2 r",
    2: "move h b c; move rob r c",
    3: "hand_over rob h k2 c",
    4: "move h c d",
    5: "move h d g",
    6: "conduct_triage h g",
}
CASE_2_PI_H = (
    "move h a b",
    "move h b c",
    "move h c s",
    "move h s u",
    "pick_up_medkit h k u",
    "move h u s",
    "move h s c",
    "move h c g",
    "conduct_triage h g",
)
CASE_2_FETCHED = {
    1: "move h a b; move rob s u",
    2: "move h b c; pick_up_medkit rob k u",
    3: "move rob u s",
    4: "move rob s c",
    5: "hand_over rob h k c",
    6: "move h c g",
    7: "conduct_triage h g",
}


@dataclass(frozen=True, slots=True)
class Given:
    """A task with a valid result."""

    task: Task
    result: Result


def helped(**options: Any) -> Given:
    """Case 4: handed over in c at epoch 3, cost 6.2."""
    found = result(case_4(), CASE_4_HELP, human_plan=CASE_4_PI_H, window=(3, 4), discount="0.9", **options)
    return Given(case_4(), found)


def fetched(**options: Any) -> Given:
    """Case 2 with K = 0: the human waits at c, window [3, 6), cost 7."""
    task = case_2()
    fixed = {"discount": "0.5", "window_weight": "0", **options}
    return Given(task, result(task, CASE_2_FETCHED, human_plan=CASE_2_PI_H, window=(3, 6), **fixed))


def idle() -> Given:
    """Case 4 at discount 0.5: no opportunity."""
    task = case_4()
    plan = dict(enumerate(CASE_4_PI_H, start=1))
    return Given(task, result(task, plan, human_plan=CASE_4_PI_H))


def announced(**options: Any) -> Given:
    """Case 4 in communication mode."""
    fixed = {"mode": "communication", "discount": "0.9", "communication_weight": "0.5", **options}
    return Given(case_4(), result(case_4(), CASE_4_HELP, human_plan=CASE_4_PI_H, **fixed))


def endless(**options: Any) -> Given:
    """Case 4 in composite mode without a horizon, where a limit came before ``pi_H`` was known."""
    fixed = {"mode": "composite", "discount": "0.9", "horizon": "inf", **options}
    return Given(case_4(), result(case_4(), CASE_4_HELP, human_plan=None, **fixed))


def lifted(**options: Any) -> Given:
    """Case 10: two robots lift together; T = 2, discount 0.5."""
    task = case_10()
    plan = {1: "lift r1 r2", 2: "do2 h"}
    fixed = {"discount": "0.5", "horizon": 2, **options}
    return Given(task, result(task, plan, human_plan=("do1 h",), window=(1, 2), **fixed))


def lifted_with_a_goal() -> Given:
    """Case 10 where the robots want q themselves."""
    task = case_10()
    wanted = Condition((task.facts.index("q"),), ())
    return Given(replace(task, robot_goal=wanted), lifted().result)


def together() -> Given:
    """Case 9: a joint action in [1, T+1)."""
    task = case_9()
    return Given(task, result(task, {1: "do_together h r"}, human_plan=("do h",), window=(1, 2)))


def alone() -> Given:
    """Case 9 in mode individual."""
    task = case_9()
    return Given(task, result(task, {1: "do h"}, human_plan=("do h",), mode="individual"))


def jumping(**options: Any) -> Given:
    """pi_H of three steps; a robot does the first two in one, the last is left."""
    task = build(
        init="a",
        goal="d",
        actions={
            "one h": "a -> b @ 2",
            "two h": "b -> c @ 2",
            "three h": "c -> d @ 2",
            "slow h": "c -> e @ 1",
            "end h": "e -> d @ 3",
            "both r": "-> b c @ 1",
            "skip r": "-> c @ 1",
        },
    )
    plan = {1: "both r", 2: "three h"}
    return Given(task, result(task, plan, human_plan=("one h", "two h", "three h"), window=(1, 2), **options))


VALID: tuple[Callable[[], Given], ...] = (
    helped,
    fetched,
    idle,
    announced,
    lambda: announced(communication_weight="0"),
    endless,
    lambda: helped(preservation="state"),
    lambda: jumping(preservation="state"),
    lifted,
    lifted_with_a_goal,
    together,
    alone,
    jumping,
    lambda: jumping(suffix="subplan"),
    lambda: jumping(interference="strict"),
    lambda: helped(max_window=1, max_cost="human"),
    lambda: fetched(max_window=3),
)
