"""Good results of every mode, status, human model and tie rule: what the edits start from."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import serendipity
from serendipity.model import Condition, Options, Result, Script, Task
from serendipity_testing.builders import task as build
from serendipity_testing.cases import CASE_3_PLAN, case_3, case_4, case_5, case_6, case_8, case_9, case_10
from serendipity_testing.countdown import Countdown
from tests.search.modes.goals.test_worked_cases import workshop
from tests.verify.scenarios.studio import TWO_ROADS, studio, two_roads
from verify.calls.solve import solve


@dataclass(frozen=True)
class Good:
    """A right answer: the task, how it was asked, and the answer.

    Attributes:
        asked: keyword arguments of the call, options apart: ``human_plan``, ``goals`` and so on.
    """

    name: str
    task: Task
    result: Result
    asked: dict[str, Any]


def two_steps() -> Task:
    """``pi_H`` has two steps; a robot's help saves one of them, and two of the human's plans are optimal."""
    return build(
        init="a",
        goal="c",
        actions={
            "go1 h": "a -> b @ 2",
            "go2 h": "b -> c @ 2",
            "via1 h": "a -> d @ 2",
            "via2 h": "d -> c @ 2",
            "push r": "a -> e @ 1",
            "take h": "e b -> c @ 1",
            "lift h r": "a -> c @ 3",
        },
    )


def wanting(task: Task, fact: str) -> Task:
    """The same task where robots want a fact."""
    return replace(task, robot_goal=Condition((task.facts.index(fact),), ()))


def game() -> Task:
    """Silent assistance in which help takes a few rounds."""
    return build(
        init="pa",
        goal="pd",
        actions={
            "walk h a b": "pa -> pb !pa @ 2",
            "walk h b d": "pb -> pd !pb @ 3",
            "open r": "-> door @ 1",
            "slip h": "door pa -> pd !pa @ 1",
            "carry r": "pb door -> pd !pb @ 1/2",
        },
    )


def _detour() -> Task:
    """The given plan costs 6, another of the human's own 4, and with help it is 2.5."""
    return build(
        goal="g",
        actions={
            "long h": "-> a @ 3",
            "end h": "a -> g @ 3",
            "short h": "-> g @ 4",
            "lay r": "-> t @ 1",
            "hop h": "t -> g @ 2",
        },
    )


def walk() -> Task:
    """Walks of two epochs; what a robot lays out in two spares the human the second."""
    return build(
        init="a",
        goal="c",
        actions={
            "go h a b": "a -> b !a @ 2 [2]",
            "go h b c": "b -> c !b @ 2 [2]",
            "lay r": "-> t @ 1 [2]",
            "hop h": "t b -> c !b @ 1",
        },
    )


def shop() -> Task:
    """A way that is blocked in epoch 2, a door that opens with epoch 6, and somebody in the way after."""
    built = build(
        agents="h r q",
        init="a",
        goal="c",
        actions={
            "go h a b": "a !blocked -> b !a @ 2 [2]",
            "go h b c": "b open -> c !b @ 2",
            "ramp r": "-> ramp @ 1 [2]",
            "jump h": "b ramp !blocked -> c !b @ 1",
            "stand q": "!blocked -> blocked @ 1",
            "leave q": "blocked -> !blocked @ 1",
        },
    )
    script = Script(
        facts=[(1, "blocked"), (2, "!blocked"), (6, "open")], people={"q": [(3, "stand q"), (5, "leave q")]}
    )
    return built.with_script(script)


def _goals(p: object, z: object) -> list[dict[str, object]]:
    return [{"name": "p", "goal": ["p"], "prior": p}, {"name": "z", "goal": ["z"], "prior": z}]


def _found(looks: int, task: Task, **asked: Any) -> Result:
    return serendipity.plan(replace(task), deadline=Countdown(looks), **asked)


def _early(task: Task, status: str, *, bounded: bool = False, **asked: Any) -> Result:
    """An answer of a call that was cut short: the first of a status, with a bound above 0 if asked for."""
    for looks in range(2000):
        found = _found(looks, task, **asked)
        if found.status == status and (not bounded or found.lower_bound):
            return found
    raise AssertionError(f"no {status} answer")


_CALLS: tuple[tuple[str, Callable[[], Task], dict[str, Any]], ...] = (
    ("window", case_4, {"discount": "0.9"}),
    ("window strict", case_4, {"discount": "0.9", "interference": "strict", "max_cost": "human"}),
    ("no opportunity", case_4, {"discount": "0"}),
    ("free windows", case_3, {"discount": "0.9", "window_weight": 0, "human_plan": CASE_3_PLAN}),
    ("longest window", two_steps, {"discount": "0.5", "window_weight": 0, "max_window": 1}),
    ("subplan", two_steps, {"discount": "0.5", "suffix": "subplan"}),
    ("state", two_steps, {"discount": "0.5", "preservation": "state"}),
    ("joint", case_9, {"discount": "0.9"}),
    ("two robots", case_10, {"discount": "0.5", "horizon": 2}),
    ("robots' goal", lambda: wanting(case_10(), "q"), {"discount": "0.5", "horizon": 2}),
    ("idle, robots' goal", lambda: wanting(case_9(), "p"), {"discount": "0.5", "horizon": 2}),
    ("given plan", two_steps, {"human_plan": ("via1 h", "via2 h"), "discount": "0.5"}),
    ("gain alone", _detour, {"human_plan": ("long h", "end h"), "discount": "0.5"}),
    ("no human plan", case_8, {}),
    ("communication", case_4, {"mode": "communication", "discount": "0.9", "communication_weight": "0.5"}),
    ("keep prefix", two_steps, {"mode": "communication", "discount": "0.5", "keep_prefix": True}),
    ("told, no plan alone", case_8, {"mode": "communication", "horizon": 2}),
    ("told, no opportunity", case_4, {"mode": "communication", "discount": "0"}),
    ("composite", case_4, {"mode": "composite", "discount": "0.5"}),
    ("composite inf", case_10, {"mode": "composite", "discount": "0.5", "horizon": "inf"}),
    ("composite, no plan alone", case_8, {"mode": "composite"}),
    ("composite infeasible", case_8, {"mode": "composite", "horizon": 1}),
    ("individual", case_10, {"mode": "individual"}),
    ("individual infeasible", case_8, {"mode": "individual"}),
    ("observant", case_4, {"human_model": "observant", "discount": "0.9"}),
    ("observant help", case_10, {"human_model": "observant", "discount": "0.5", "horizon": 2}),
    ("observant blocking", case_10, {"human_model": "observant", "horizon": 2, "no_block": False}),
    ("local", case_10, {"human_model": "local", "discount": "0.5", "horizon": 2}),
    ("robust", case_4, {"ties": "robust", "discount": "0.9"}),
    ("optimistic", case_4, {"ties": "optimistic", "discount": "0.9"}),
    ("expected", case_4, {"ties": "expected", "discount": "0.9"}),
    ("expected of one", case_10, {"ties": "expected", "discount": "0.5", "horizon": 2}),
    ("told, robust", two_steps, {"mode": "communication", "ties": "robust", "communication_weight": 1}),
    ("assistance fixed", case_5, {"mode": "assistance", "ties": "fixed"}),
    ("assistance robust", case_5, {"mode": "assistance", "ties": "robust"}),
    ("assistance expected", case_5, {"mode": "assistance", "ties": "expected"}),
    ("assistance optimistic", game, {"mode": "assistance", "ties": "optimistic"}),
    ("assistance no block", case_6, {"mode": "assistance", "no_block": True}),
    ("assistance infeasible", lambda: build(goal="g", actions={"wait r": "-> x"}), {"mode": "assistance"}),
    ("in time", walk, {"discount": "0.5"}),
    ("in time, free windows", walk, {"discount": "0.5", "window_weight": 0, "horizon": 6}),
    ("in time, no help", walk, {"discount": "0"}),
    ("in time, a head start", walk, {"discount": "0.5", "head_start": 1, "interference": "strict"}),
    ("in time, told", walk, {"mode": "communication", "communication_weight": "0.5", "discount": "0.5"}),
    ("in time, composite", walk, {"mode": "composite", "discount": "0.5"}),
    ("in time, composite inf", walk, {"mode": "composite", "discount": "0.5", "horizon": "inf"}),
    ("in time, individual", walk, {"mode": "individual"}),
    ("a script", shop, {"discount": "0.5"}),
    ("a script, composite", shop, {"mode": "composite", "discount": "0.5", "horizon": 8}),
    ("a script, individual", shop, {"mode": "individual"}),
    ("a script, a limit", shop, {"mode": "composite", "horizon": 7, "max_cost": 0}),
    ("goals", lambda: workshop("!q -> z @ 5"), {"goals": _goals(1, 1), "horizon": 2}),
    ("goals, no help", lambda: workshop("!q -> z @ 5"), {"goals": _goals(1, 9), "horizon": 2}),
    ("goals, one left", lambda: workshop("!q -> z @ 5"), {"goals": _goals(1, 0), "horizon": 2}),
    ("goals, observed", lambda: workshop("!q -> z @ 5"), {"goals": _goals(1, 1), "observed": ["keep h"]}),
    ("goals, none", case_8, {"goals": [{"goal": ["conducted_triage h a"]}]}),
    ("policy", studio, {"goals": _goals(1, 1), "horizon": 3}),
    ("policy, worst", studio, {"goals": _goals(1, 3), "horizon": 3, "risk": "worst", "policy": "fixed"}),
    ("policy, regret", studio, {"goals": _goals(1, 1), "horizon": 3, "risk": "regret"}),
    ("watched", two_roads, {"ties": "watched"}),
    ("library", two_roads, {"plans": TWO_ROADS}),
)


_CUT_SHORT: tuple[tuple[str, Callable[[], Task], str, bool, dict[str, Any]], ...] = (
    ("feasible", case_4, "feasible", True, {"discount": "0.9"}),
    ("feasible composite", case_4, "feasible", True, {"mode": "composite", "discount": "0.5"}),
    ("feasible observant", case_4, "feasible", False, {"human_model": "observant", "discount": "0.9"}),
    ("unknown", case_4, "unknown", False, {"discount": "0.9"}),
    ("unknown composite", case_8, "unknown", False, {"mode": "composite"}),
    ("unknown assistance", case_5, "unknown", False, {"mode": "assistance", "ties": "robust"}),
)


@cache
def corpus() -> tuple[Good, ...]:
    """The good results, those of ``solve`` among them."""
    return tuple(_made())


def _made() -> Iterator[Good]:
    for name, make, asked in _CALLS:
        task = make()
        yield Good(name, task, serendipity.plan(task, **asked), asked)
    for name, make, status, bounded, asked in _CUT_SHORT:
        task = make()
        yield Good(name, task, _early(task, status, bounded=bounded, **asked), asked)
    idle = {"mode": "assistance", "time_limit": 0}
    yield Good("feasible assistance", game(), serendipity.plan(game(), **idle), idle)
    for name, make, asked in _CALLS[:5]:
        task = make()
        if "human_plan" not in asked:
            yield Good(f"solve {name}", task, solve(task, Options(**asked)), asked)
