"""Bugs in lower bounds: what is cut off though it could still pay."""

from typing import Any

from search.packed.cost_vector import INFINITE_KEY
from tests.verify.planted.bug import Bug, always, replaced, wrapped
from tests.verify.planted.roles import part, put


def _doubled(original: Any, *arguments: Any) -> dict[int, int]:
    return {state: 2 * key for state, key in original(*arguments).items()}


def _zero(original: Any, *arguments: Any) -> dict[int, int]:
    return dict.fromkeys(original(*arguments), 0)


def _own_moves(original: Any, fields: Any, forms: Any, *arguments: Any) -> Any:
    return original(fields, [f for f in forms if not f[0].agents & (f[0].agents - 1)], *arguments)


def _too_late(original: Any, self: Any, *arguments: Any) -> None:
    original(self, *arguments)
    put(self, "latest epoch of a need", part(self, "latest epoch of a need") - 2)


def _no_help(self: Any, epoch: int, state: int, idle: Any = ()) -> int:
    without = part(part(self, "bounds along pi_H"), "bounds without help")
    return int(without[epoch] - part(self, "spent along pi_H")[epoch])


def _no_help_later(original: Any, self: Any, epoch: int, state: int, idle: Any = ()) -> int:
    return max(original(self, epoch, state, idle), _no_help(self, epoch, state))


def _cheapest_need(original: Any, *arguments: Any) -> list[int] | None:
    paying: list[int] | None = original(*arguments)
    return paying[:1] if paying else paying


def _achieved_is_never(original: Any, self: Any, state: int) -> int:
    known: int = original(self, state)
    return known or INFINITE_KEY


def _without_handing_over(original: Any, self: Any, spot: Any) -> Any:
    return [edge for edge in original(self, spot) if edge[1][2]]


def _never_flipped(original: Any, self: Any, *arguments: Any) -> None:
    original(self, *arguments)
    put(self, "what pi_H changes", type(part(self, "what pi_H changes"))(0))


def _slow_walks(original: Any, self: Any, *arguments: Any) -> None:
    original(self, *arguments)
    for walks in part(self, "walks").values():
        walks.always.clear()
        walks.by_value.clear()


def _far_goal(original: Any, self: Any, *arguments: Any) -> Any:
    found = original(self, *arguments)
    steps_after = part(self, "steps after a need")
    put(self, "steps after a need", {need: steps + 2 for need, steps in steps_after.items()})
    return found


def _own_interactions(original: Any, self: Any, action: int) -> bool:
    packed = part(self, "packed task")
    alone = part(packed, "operator")(action).agents == part(packed, "the human's bit")
    return original(self, action) and alone


def _limit_is_exact(original: Any, self: Any, start: int, limit: int) -> int:
    found: int = original(self, start, limit)
    part(self, "known costs alone")[start] = found
    return found


def _dear(original: Any, self: Any, *arguments: Any) -> Any:
    found = original(self, *arguments)
    for provided in found.values():
        cost = part(provided, "cost of achievers")
        put(provided, "steps of achievers", part(provided, "steps of achievers"))
        put(provided, "cost of achievers", lambda state, cost=cost: 3 * cost(state))
    return found


def _too_dear_soon(original: Any, self: Any, need: int, slack: int) -> Any:
    return original(self, need, slack // 2)


_SLOWER = "a weaker bound is still a bound: the search only takes longer"

BUGS = (
    Bug("distances in the pattern database", "doubled", wrapped(_doubled)),
    Bug("distances in the pattern database", "all zero", wrapped(_zero), survives=_SLOWER),
    Bug("bound of the first interaction", "says nothing", replaced(always(0)), survives=_SLOWER),
    Bug("actions in the pattern database", "joint actions are forgotten", wrapped(_own_moves)),
    Bug(
        "search for the human's plan alone",
        "a value beyond the limit is taken for exact",
        wrapped(_limit_is_exact),
        crashes="AssertionError",
    ),
    Bug("whether an action is an interaction", "a joint action is none", wrapped(_own_interactions)),
    Bug("private distances", "the goal is two actions further", wrapped(_far_goal)),
    Bug("a need that may pay", "help has to come two epochs earlier", wrapped(_too_late)),
    Bug("bound if the window opens now", "nobody helps", replaced(_no_help)),
    Bug("bound if the window opens later", "nobody helps", wrapped(_no_help_later)),
    Bug("needs that may still pay", "only the first is kept", wrapped(_cheapest_need)),
    Bug("epochs that a cost takes", "twice as many", wrapped(lambda f, self, cost: 2 * f(self, cost))),
    Bug("achievers of a need", "three times as dear", wrapped(_dear)),
    Bug(
        "phases of pi_H",
        "pi_H changes nothing outside",
        wrapped(lambda _, __, epochs: [(0, epochs)]),
    ),
    Bug("longest window that may pay", "a window has no time for robots", replaced(always(0))),
    Bug("cost to achieve a need", "what is achieved already is out of reach", wrapped(_achieved_is_never)),
    Bug("edges of the achiever automaton", "nothing is handed over", wrapped(_without_handing_over)),
    Bug("what pi_H changes in the achiever automaton", "nothing", wrapped(_never_flipped)),
    Bug(
        "slack of the achiever automaton",
        "half of what robots may pay is too much",
        wrapped(_too_dear_soon),
    ),
    Bug("robots' walks in the transition graph", "robots can't walk", wrapped(_slow_walks)),
)
