"""Bugs in costs, orders and suffixes: weights, dominance, the human's way after the window."""

from dataclasses import replace
from typing import Any

from search.packed.cost_vector import INFINITE_KEY
from tests.verify.planted.bug import Bug, always, replaced, wrapped
from tests.verify.planted.roles import part, put


def _free_windows(original: Any, self: Any, *arguments: Any) -> None:
    original(self, *arguments)
    layout = part(self, "layout")
    put(self, "layout", replace(layout, epoch_weight=1 << layout.length_shift))


def _undiscounted(original: Any, self: Any, *arguments: Any) -> None:
    original(self, *arguments)
    put(self, "robots' weights", part(self, "human's weights"))


def _discount_for_all(original: Any, self: Any, *arguments: Any) -> None:
    original(self, *arguments)
    put(self, "human's weights", part(self, "robots' weights"))


def _unannounced(self: Any, op: Any) -> Any:
    whose = "human's weights" if op.agents & part(self, "the human's bit in weights") else "robots' weights"
    return part(self, whose)[op.cost]


def _any_length(original: Any, self: Any, state: int, epochs: int, start: int, limit: int) -> Any:
    return original(self, state, 10**6, start, limit)


def _whatever_robots_want(self: Any, state: int, epochs: int, start: int, limit: int) -> Any:
    layout = part(self, "layout of a replanned suffix")
    own = part(self, "planner of a replanned suffix").key(state, limit)
    too_long = own >= limit or layout.actions(own) > epochs
    return INFINITE_KEY if too_long else layout.announce(own)


def _all_steps(original: Any, self: Any, state: int, epochs: int, start: int, limit: int) -> Any:
    return original(self, state, len(part(self, "steps of a suffix from pi_H")), start, limit)


def _any_goal(original: Any, self: Any, *arguments: Any) -> None:
    original(self, *arguments)
    put(self, "goals", part(self, "goals")[:1])


def _any_state(self: Any, state: int, epochs: int, start: int) -> list[int]:
    steps = len(part(self, "steps of a preserved suffix"))
    first = max(start - 1, steps - epochs)
    return [j for j in range(first, steps + 1) if part(self, "whether the rest works")(state, j)]


def _any_end(original: Any, self: Any, state: int, epochs: int, start: int) -> Any:
    return original(self, state, epochs, 1)


def _by_key_alone(self: Any, labels: Any, epoch: int, key: int, idle: Any) -> bool:
    return any(k <= key for _, k, _ in labels)


def _by_epoch_alone(self: Any, labels: Any, epoch: int, key: int, idle: Any) -> bool:
    return any(t <= epoch for t, _, _ in labels)


def _never_busy(self: Any, labels: Any, epoch: int, key: int, idle: Any) -> bool:
    no_worse = part(self, "order of limits") or always(True)
    return any(t <= epoch and k <= key and no_worse(k, key) for t, k, _ in labels)


def _no_other_order(original: Any, self: Any, no_worse: Any = None) -> None:
    original(self, None)


def _largest(self: Any) -> Any:
    *_, last = part(self, "all plans")()
    return last


def _not_announced(original: Any, self: Any, key: int) -> int:
    return key


def _prefer_early(original: Any, self: Any, start: int, horizon: int) -> Any:
    return start << self.start_shift


_TIES = "a tie: 'optimal' stands for objective and cost, not for the order beyond (semantics 3.1)"

BUGS = (
    Bug("weights of operators", "epochs of the window are free", wrapped(_free_windows)),
    Bug("weights of operators", "robots get no discount", wrapped(_undiscounted)),
    Bug("weights of operators", "the human is discounted too", wrapped(_discount_for_all)),
    Bug("cost of a joint action", "communication is free", replaced(_unannounced)),
    Bug("cost of communicating a suffix", "communication is free", wrapped(_not_announced)),
    Bug(
        "cost vector of an action",
        "actions are not counted",
        replaced(lambda self, cost: self.of_cost(cost)),
        crashes="AssertionError: asked for plans where there are none",
    ),
    Bug(
        "cost vector of a window's start",
        "an earlier window is preferred",
        wrapped(_prefer_early),
        survives=_TIES,
    ),
    Bug("dominance between labels", "later but cheaper dominates", replaced(_by_key_alone)),
    Bug("dominance between labels", "earlier but dearer dominates", replaced(_by_epoch_alone)),
    Bug("dominance between labels", "busy robots dominate idle ones", replaced(_never_busy)),
    Bug("limits in dominance", "they don't count", wrapped(_no_other_order)),
    Bug("cost of a replanned suffix", "it may pass T", wrapped(_any_length)),
    Bug("cost of a replanned suffix", "the robots' goal is forgotten", replaced(_whatever_robots_want)),
    Bug("cost of a suffix from pi_H", "it may pass T", wrapped(_all_steps)),
    Bug("goals of a suffix from pi_H", "the robots' goal is forgotten", wrapped(_any_goal)),
    Bug(
        "steps of pi_H where a preserved suffix may begin",
        "any state is preserved",
        replaced(_any_state),
    ),
    Bug(
        "steps of pi_H where a preserved suffix may begin",
        "the rest may start before the window",
        wrapped(_any_end),
        survives="such a plan does steps of pi_H twice, so it costs no less than pi_H",
    ),
    Bug("the canonical plan", "the last in string order", replaced(_largest)),
)
