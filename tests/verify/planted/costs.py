"""Bugs in costs, orders and suffixes: weights, dominance, the human's way after the window."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from search.engine.dominance import ParetoFront
from search.human.individual_planner import PlanGraph
from search.human.plan_suffix import PlanSuffix
from search.human.suffix_rules import Replan
from search.packed.cost_vector import INFINITE_KEY, CostLayout, Weights
from search.packed.packed_task import PackedGoal
from tests.verify.planted.bug import Bug, Change, afterwards, always, replaced, wrapped


def _free_windows(weights: Weights) -> CostLayout:
    return replace(weights.keys, epoch_weight=1 << weights.keys.length_shift)


def _any_state(suffix: Any) -> list[PackedGoal] | None:
    return suffix._expected and [PackedGoal(0, 0, ()) for _ in suffix._expected]


def _unannounced(self: Any, op: Any) -> Any:
    return (self.human if op.agents & self._human_bit else self.robots)[op.cost]


def _any_length(original: Any, self: Any, state: int, epochs: int, start: int, limit: int) -> Any:
    return original(self, state, 10**6, start, limit)


def _whatever_robots_want(self: Any, state: int, epochs: int, start: int, limit: int) -> Any:
    layout = self.keys
    own = self.alone.key(state, limit)
    too_long = own >= limit or layout.actions(own) > epochs
    return INFINITE_KEY if too_long else layout.announce(own)


def _all_steps(original: Any, self: Any, state: int, epochs: int, start: int, limit: int) -> Any:
    return original(self, state, len(self._first), start, limit)


def _by_key_alone(front: Any, known: Any, new: Any) -> bool:
    return bool(known[1] <= new[1])


def _by_epoch_alone(front: Any, known: Any, new: Any) -> bool:
    return bool(known[0] <= new[0])


def _never_busy(front: Any, known: Any, new: Any) -> bool:
    no_worse = front._no_worse or always(True)
    return known[0] <= new[0] and known[1] <= new[1] and no_worse(known[1], new[1])


def _dominated(wrongly: Callable[[Any, Any, Any], bool]) -> Change:
    """Labels left out, too, that another one dominates in a wrong way."""

    def add(original: Any, self: Any, state: Any, epoch: int, key: int, idle: Any = ()) -> bool:
        known = self._labels.get(state, [])
        labels = [known] if isinstance(known, tuple) else known
        is_left_out = any(wrongly(self, one, (epoch, key)) for one in labels)
        return not is_left_out and original(self, state, epoch, key, idle)

    return wrapped(add)


def _no_other_order(original: Any, self: Any, no_worse: Any = None) -> None:
    original(self, None)


def _largest(self: Any) -> Any:
    *_, last = self.plans()
    return last


BUGS = (
    Bug(Weights, "__init__", "epochs of the window are free", afterwards(keys=_free_windows)),
    Bug(Weights, "__init__", "robots get no discount", afterwards(robots=lambda weights: weights.human)),
    Bug(Weights, "__init__", "the human is discounted too", afterwards(human=lambda weights: weights.robots)),
    Bug(Weights, "team", "communication is free", replaced(_unannounced)),
    Bug(ParetoFront, "add", "later but cheaper dominates", _dominated(_by_key_alone)),
    Bug(ParetoFront, "add", "earlier but dearer dominates", _dominated(_by_epoch_alone)),
    Bug(ParetoFront, "add", "busy robots dominate idle ones", _dominated(_never_busy)),
    Bug(ParetoFront, "__init__", "they don't count", wrapped(_no_other_order)),
    Bug(Replan, "key", "it may pass T", wrapped(_any_length)),
    Bug(Replan, "key", "the robots' goal is forgotten", replaced(_whatever_robots_want)),
    Bug(PlanSuffix, "key", "it may pass T", wrapped(_all_steps)),
    Bug(
        PlanSuffix,
        "__init__",
        "the robots' goal is forgotten",
        afterwards(_goals=lambda suffix: suffix._goals[:1]),
    ),
    Bug(PlanSuffix, "__init__", "any state is preserved", afterwards(_expected=_any_state)),
    Bug(PlanGraph, "canonical", "the last in string order", replaced(_largest)),
)
