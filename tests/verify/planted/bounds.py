"""Bugs in lower bounds: what is cut off though it could still pay."""

from typing import Any

from search.heuristics.achiever_automaton import AchieverAutomaton, AchieverCosts
from search.heuristics.achievers import Achievers, Provided
from search.heuristics.first_interaction import FirstInteraction, _Promise
from search.heuristics.interactions import Interactions
from search.heuristics.prefix_bounds import FirstInteractionOnTheWay
from search.heuristics.private_distances import PrivateDistances
from search.human import pattern_database as projection
from search.human.individual_planner import IndividualPlanner
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operator_index import OperatorIndex
from search.packed.successor_generator import Idle
from search.robots.transition_graphs import TransitionGraph
from search.spaces import factory as windows
from tests.verify.planted.bug import Bug, always, replaced, wrapped


def _doubled(original: Any, *arguments: Any) -> dict[int, int]:
    return {state: 2 * key for state, key in original(*arguments).items()}


def _zero(original: Any, *arguments: Any) -> dict[int, int]:
    return dict.fromkeys(original(*arguments), 0)


def _own_moves(original: Any, fields: Any, forms: Any, *arguments: Any) -> Any:
    return original(fields, [f for f in forms if not f[0].agents & (f[0].agents - 1)], *arguments)


def _too_late(original: Any, self: _Promise, *arguments: Any) -> None:
    original(self, *arguments)
    self.latest -= 2


def _no_help(self: FirstInteractionOnTheWay, epoch: int, state: int, idle: Idle = ()) -> int:
    return self._openings.without[epoch] - self._spent[epoch]


def _no_help_later(
    original: Any, self: FirstInteractionOnTheWay, epoch: int, state: int, idle: Idle = ()
) -> int:
    return max(original(self, epoch, state, idle), _no_help(self, epoch, state))


def _cheapest_need(original: Any, *arguments: Any) -> list[int] | None:
    paying = original(*arguments)
    return paying[:1] if paying else paying


def _provided_is_never(original: Any, self: AchieverCosts, state: int) -> int:
    known = original(self, state)
    return known or INFINITE_KEY


def _without_handing_over(original: Any, self: AchieverAutomaton, spot: Any) -> Any:
    return [edge for edge in original(self, spot) if edge[1][2]]


def _never_flipped(original: Any, self: AchieverAutomaton, *arguments: Any) -> None:
    original(self, *arguments)
    self._flips = OperatorIndex(0)


def _slow_walks(original: Any, self: TransitionGraph, *arguments: Any) -> None:
    original(self, *arguments)
    for walks in self.walks.values():
        walks.always.clear()
        walks.by_value.clear()


def _far_goal(original: Any, self: PrivateDistances, *arguments: Any) -> Any:
    found = original(self, *arguments)
    self.steps_after = {need: steps + 2 for need, steps in self.steps_after.items()}
    return found


def _own_interactions(original: Any, self: Interactions, action: int) -> bool:
    return original(self, action) and self._packed.op(action).agents == self._packed.human_bit


def _limit_is_exact(original: Any, self: IndividualPlanner, start: int, limit: int) -> int:
    found: int = original(self, start, limit)
    self._known[start] = found
    return found


def _dear(original: Any, self: Achievers, *arguments: Any) -> dict[int, Provided]:
    found = original(self, *arguments)
    for provided in found.values():
        cost = provided.cost
        provided.__dict__["_steps"] = provided._steps
        provided.__dict__["cost"] = lambda state, cost=cost: 3 * cost(state)
    return found


def _too_dear_soon(original: Any, self: AchieverAutomaton, need: int, slack: int) -> AchieverCosts:
    found: AchieverCosts = original(self, need, slack // 2)
    return found


_SLOWER = "a weaker bound is still a bound: the search only takes longer"

BUGS = (
    Bug("projection", "distances are doubled", wrapped(projection, "backward", _doubled)),
    Bug("projection", "distances are all zero", wrapped(projection, "backward", _zero), _SLOWER),
    Bug("help: Helped", "says nothing", replaced(FirstInteraction, "__call__", always(0)), _SLOWER),
    Bug("projection", "joint actions are forgotten", wrapped(projection, "_transitions", _own_moves)),
    Bug(
        "alone: _search",
        "a value beyond the limit is taken for exact",
        wrapped(IndividualPlanner, "_search", _limit_is_exact),
    ),
    Bug(
        "touches: is_touch",
        "a joint action is none",
        wrapped(Interactions, "is_interaction", _own_interactions),
    ),
    Bug("ways: explore", "the goal is two actions further", wrapped(PrivateDistances, "explore", _far_goal)),
    Bug("help: Helped", "help has to come two epochs earlier", wrapped(_Promise, "__init__", _too_late)),
    Bug("help: opening", "nobody helps", replaced(FirstInteractionOnTheWay, "opening", _no_help)),
    Bug("help: later", "nobody helps later", wrapped(FirstInteractionOnTheWay, "later", _no_help_later)),
    Bug("help: survivors", "only the first need is kept", wrapped(windows, "survivors", _cheapest_need)),
    Bug(
        "help: Providers.epochs",
        "twice as many",
        wrapped(Achievers, "epochs", lambda f, self, cost: 2 * f(self, cost)),
    ),
    Bug("help: Providers.provided", "three times as dear", wrapped(Achievers, "provided", _dear)),
    Bug(
        "help: phases",
        "pi_H changes nothing outside",
        wrapped(Achievers, "phases", lambda _, __, epochs: [(0, epochs)]),
    ),
    Bug("windows: _reach", "a window has no time for robots", replaced(windows, "_reach", always(0))),
    Bug(
        "provision: Distances",
        "what is provided already is out of reach",
        wrapped(AchieverCosts, "__call__", _provided_is_never),
    ),
    Bug(
        "provision: tracking",
        "is never handed over",
        wrapped(AchieverAutomaton, "_changes", _without_handing_over),
    ),
    Bug(
        "provision: flips",
        "pi_H changes no field on the way",
        wrapped(AchieverAutomaton, "__init__", _never_flipped),
    ),
    Bug(
        "provision: distances",
        "half of what robots may pay is too much",
        wrapped(AchieverAutomaton, "distances", _too_dear_soon),
    ),
    Bug("acts: walks", "robots can't walk", wrapped(TransitionGraph, "__init__", _slow_walks)),
)
