"""Bugs in costs, orders and suffixes: keys, dominance, the human's way after the window."""

from dataclasses import replace
from typing import Any

from search.engine.dominance import Label, ParetoFront
from search.human.individual_planner import PlanGraph
from search.human.suffix_rules import Preserved, Replan, Subplan
from search.packed.cost_vector import INFINITE_KEY, CostLayout, Weights
from search.packed.operators import Operator
from search.packed.successor_generator import Idle
from tests.verify.planted.bug import Bug, always, replaced, wrapped


def _free_windows(original: Any, self: Weights, *arguments: Any) -> None:
    original(self, *arguments)
    self.keys = replace(self.keys, epoch_weight=1 << self.keys.length_shift)


def _undiscounted(original: Any, self: Weights, *arguments: Any) -> None:
    original(self, *arguments)
    self.robots = self.human


def _discount_for_all(original: Any, self: Weights, *arguments: Any) -> None:
    original(self, *arguments)
    self.human = self.robots


def _unannounced(self: Weights, op: Operator) -> int:
    return self.human[op.cost] if op.agents & self._human_bit else self.robots[op.cost]


def _any_length(original: Any, self: Replan, state: int, epochs: int, start: int, limit: int) -> int:
    return original(self, state, 10**6, start, limit)


def _whatever_robots_want(self: Replan, state: int, epochs: int, start: int, limit: int) -> int:
    own = self._alone.key(state, limit)
    too_long = own >= limit or self._keys.actions(own) > epochs
    return INFINITE_KEY if too_long else self._keys.announce(own)


def _all_steps(original: Any, self: Subplan, state: int, epochs: int, start: int, limit: int) -> int:
    return original(self, state, len(self._steps), start, limit)


def _any_goal(original: Any, self: Subplan, *arguments: Any) -> None:
    original(self, *arguments)
    self._goals = self._goals[:1]


def _any_state(self: Preserved, state: int, epochs: int, start: int) -> list[int]:
    first = max(start - 1, len(self._ops) - epochs)
    return [j for j in range(first, len(self._ops) + 1) if self._works(state, j)]


def _any_end(original: Any, self: Preserved, state: int, epochs: int, start: int) -> list[int]:
    return original(self, state, epochs, 1)


def _by_key_alone(self: ParetoFront, labels: list[Label], epoch: int, key: int, idle: Idle) -> bool:
    return any(k <= key for _, k, _ in labels)


def _by_epoch_alone(self: ParetoFront, labels: list[Label], epoch: int, key: int, idle: Idle) -> bool:
    return any(t <= epoch for t, _, _ in labels)


def _never_busy(self: ParetoFront, labels: list[Label], epoch: int, key: int, idle: Idle) -> bool:
    no_worse = self._no_worse or always(True)
    return any(t <= epoch and k <= key and no_worse(k, key) for t, k, _ in labels)


def _no_other_order(original: Any, self: ParetoFront, no_worse: Any = None) -> None:
    original(self, None)


def _largest(self: PlanGraph) -> tuple[int, ...]:
    *_, last = self.plans()
    return last


def _not_announced(original: Any, self: CostLayout, key: int) -> int:
    return key


def _prefer_early(original: Any, self: CostLayout, start: int, horizon: int) -> int:
    return start << self.start_shift


_TIES = "a tie: 'optimal' stands for objective and cost, not for the order beyond (SPEC 3.1)"

BUGS = (
    Bug("keys: Weights", "epochs of the window are free", wrapped(Weights, "__init__", _free_windows)),
    Bug("keys: Weights", "robots get no discount", wrapped(Weights, "__init__", _undiscounted)),
    Bug("keys: Weights", "the human is discounted too", wrapped(Weights, "__init__", _discount_for_all)),
    Bug("keys: Weights.team", "communication is free", replaced(Weights, "team", _unannounced)),
    Bug(
        "keys: announce",
        "communication is free in the suffix",
        wrapped(CostLayout, "announce", _not_announced),
    ),
    Bug(
        "keys: of_action",
        "actions are not counted",
        replaced(CostLayout, "of_action", lambda self, cost: self.of_cost(cost)),
    ),
    Bug(
        "keys: of_start",
        "an earlier window is preferred",
        wrapped(CostLayout, "of_start", _prefer_early),
        _TIES,
    ),
    Bug("labels: add", "later but cheaper dominates", replaced(ParetoFront, "_covered", _by_key_alone)),
    Bug("labels: add", "earlier but dearer dominates", replaced(ParetoFront, "_covered", _by_epoch_alone)),
    Bug("labels: add", "busy robots dominate idle ones", replaced(ParetoFront, "_covered", _never_busy)),
    Bug(
        "labels: no_worse",
        "limits don't count in dominance",
        wrapped(ParetoFront, "__init__", _no_other_order),
    ),
    Bug("suffix: Replan", "the suffix may pass T", wrapped(Replan, "key", _any_length)),
    Bug("suffix: Replan", "the robots' goal is forgotten", replaced(Replan, "key", _whatever_robots_want)),
    Bug("suffix: Subplan", "the suffix may pass T", wrapped(Subplan, "key", _all_steps)),
    Bug("suffix: Subplan", "the robots' goal is forgotten", wrapped(Subplan, "__init__", _any_goal)),
    Bug("suffix: Preserved", "any state is preserved", replaced(Preserved, "_fitting", _any_state)),
    Bug(
        "suffix: Preserved",
        "the rest may start before the window",
        wrapped(Preserved, "_fitting", _any_end),
        "such a plan does steps of pi_H twice, so it costs no less than pi_H",
    ),
    Bug(
        "alone: PlanGraph.canonical",
        "the last in string order",
        replaced(PlanGraph, "canonical", _largest),
        "an optimal pi_H may have been given; the certificate says that it is not the canonical one",
    ),
)
