"""Bugs in what a mode allows, and in how its space is searched."""

from collections.abc import Iterable, Iterator
from typing import Any

from search import planner
from search.engine.best_first import Incumbent, Node
from search.packed.cost_vector import CostLayout
from search.packed.successor_generator import NOTHING, JointAction
from search.planner import _Call
from search.spaces.fixed_human_plan import FixedHumanPlan
from search.spaces.unrestricted import Unrestricted
from search.spaces.windowed import AnyOfPlan, Timetable, Windowed
from tests.verify.planted.bug import Bug, always, replaced, wrapped


def _unchecked(self: Timetable, epoch: int, state: int) -> Iterable[JointAction]:
    return (self._steps[epoch - 1][1],)


def _own_actions(self: AnyOfPlan, epoch: int, state: int) -> Iterable[JointAction]:
    return (NOTHING, *self._successors.human(state))


def _only_waiting(self: AnyOfPlan, epoch: int, state: int) -> Iterable[JointAction]:
    return (NOTHING,)


def _joint_before(self: AnyOfPlan, epoch: int, state: int) -> Iterable[JointAction]:
    own = self._successors.human(state)
    planned = (option for option in own if self._actions[option.actions[0]].name in self._planned)
    return (NOTHING, *planned, *self._successors.joint(state))


def _later_start(original: Any, self: Windowed, node: Node) -> Iterator[tuple[int, Node]]:
    for bound, opened in original(self, node):
        yield bound, opened._replace(start=opened.start + 1)


def _longer(original: Any, self: Windowed, **keywords: Any) -> None:
    original(self, **{**keywords, "max_window": keywords["max_window"] + 1})


def _one_epoch(original: Any, self: Windowed, **keywords: Any) -> None:
    original(self, **{**keywords, "max_window": 1})


def _shorter_horizon(original: Any, self: Any, **keywords: Any) -> None:
    horizon = keywords["horizon"]
    original(self, **{**keywords, "horizon": horizon and horizon - 1})


def _longer_horizon(original: Any, self: Any, **keywords: Any) -> None:
    horizon = keywords["horizon"]
    original(self, **{**keywords, "horizon": None if horizon is None else horizon + 1})


def _only_from_the_start(original: Any, self: Windowed, node: Node) -> Iterator[tuple[int, Node]]:
    if node.epoch == 0:
        yield from original(self, node)


def _late_end(original: Any, self: Windowed, node: Node, best: Incumbent) -> None:
    known = best.node
    original(self, node, best)
    if best.node is not known:
        best.end -= 1


def _own_goal(original: Any, self: Any, **keywords: Any) -> None:
    original(self, **{**keywords, "goals": keywords["goals"][:1]})


def _first_is_best(space: Any, best: Incumbent, progress: Any, deadline: Any) -> Iterator[Incumbent]:
    found = best_first(space, best, progress, deadline)
    yield from (answer for answer, _ in zip(found, range(1), strict=False))


best_first = planner.best_first


def _never_dear(self: CostLayout, key: int, most_cost: int | None) -> bool:
    return False


def _dear_at_the_limit(self: CostLayout, key: int, most_cost: int | None) -> bool:
    return most_cost is not None and self.scaled_cost(key) >= most_cost


def _ties_help(self: _Call) -> bool:
    if self.plan is None or self.best.node is None:
        return False
    return self.keys.cost(self.best.key) <= self.keys.cost(self.idle.key)


def _nothing_helps(self: _Call) -> bool:
    return False


BUGS = (
    Bug(
        "windowed: Timetable",
        "pi_H is followed where it is not applicable",
        replaced(Timetable, "options", _unchecked),
    ),
    Bug("windowed: AnyOfPlan", "any own action is in pi_H", replaced(AnyOfPlan, "options", _own_actions)),
    Bug(
        "windowed: AnyOfPlan",
        "he only waits before the window",
        replaced(AnyOfPlan, "options", _only_waiting),
    ),
    Bug(
        "windowed: AnyOfPlan",
        "joint actions before the window",
        replaced(AnyOfPlan, "options", _joint_before),
    ),
    Bug(
        "windowed: _open",
        "the window is said to start an epoch later",
        wrapped(Windowed, "_open", _later_start),
    ),
    Bug(
        "windowed: _open",
        "the window opens in epoch 1 only",
        wrapped(Windowed, "_open", _only_from_the_start),
    ),
    Bug("windowed: _end", "the window is said to end an epoch earlier", wrapped(Windowed, "_end", _late_end)),
    Bug("windowed: max_window", "an epoch more", wrapped(Windowed, "__init__", _longer)),
    Bug("windowed: max_window", "always 1", wrapped(Windowed, "__init__", _one_epoch)),
    Bug("windowed: horizon", "an epoch less", wrapped(Windowed, "__init__", _shorter_horizon)),
    Bug("windowed: horizon", "an epoch more", wrapped(Windowed, "__init__", _longer_horizon)),
    Bug("max_cost", "ignored", replaced(CostLayout, "exceeds", _never_dear)),
    Bug("max_cost", "the limit itself is too dear", replaced(CostLayout, "exceeds", _dear_at_the_limit)),
    Bug("free: horizon", "an epoch less", wrapped(Unrestricted, "__init__", _shorter_horizon)),
    Bug("free: horizon", "an epoch more", wrapped(Unrestricted, "__init__", _longer_horizon)),
    Bug("free: goals", "the robots' goal is forgotten", wrapped(Unrestricted, "__init__", _own_goal)),
    Bug("followed: goals", "the robots' goal is forgotten", wrapped(FixedHumanPlan, "__init__", _own_goal)),
    Bug(
        "best_first",
        "the first plan found is called optimal",
        replaced(planner, "best_first", _first_is_best),
    ),
    Bug("planner: _helps", "a tie is an opportunity", replaced(_Call, "_helps", _ties_help)),
    Bug("planner: _helps", "nothing is an opportunity", replaced(_Call, "_helps", _nothing_helps)),
    Bug(
        "planner: _improve_alone",
        "a given plan is taken for optimal",
        replaced(_Call, "_improve_alone", always(None)),
    ),
)
