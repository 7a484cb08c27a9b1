"""Bugs in lower bounds: what is cut off though it could still pay."""

from typing import Any

from search.bounds import first_interaction
from search.bounds.achiever_automaton import AchieverAutomaton
from search.bounds.achiever_costs import AchieverCosts
from search.bounds.achievers import Achievers
from search.bounds.first_interaction import _Promise
from search.bounds.interactions import Interactions
from search.bounds.prefix_bounds import FirstInteractionOnTheWay
from search.bounds.private_distances import PrivateDistances
from search.human import pattern_database
from search.packed.cost_vector import INFINITE_KEY
from search.robots.transition_graphs import TransitionGraph
from search.spaces import factory
from tests.verify.planted.bug import Bug, afterwards, always, replaced, returning, wrapped


def _own_moves(original: Any, fields: Any, forms: Any, *arguments: Any) -> Any:
    return original(fields, [f for f in forms if not f[0].agents & (f[0].agents - 1)], *arguments)


def _no_help(self: Any, epoch: int, state: int, idle: Any = ()) -> int:
    without = self._openings.without
    return int(without[epoch] - self._spent[epoch])


def _no_help_later(original: Any, self: Any, epoch: int, state: int, idle: Any = ()) -> int:
    return max(original(self, epoch, state, idle), _no_help(self, epoch, state))


def _slow_walks(original: Any, self: Any, *arguments: Any) -> None:
    original(self, *arguments)
    for walks in self.walks.values():
        walks.always.clear()
        walks.by_value.clear()


def _two_further(distances: Any) -> dict[Any, int]:
    return {need: steps + 2 for need, steps in distances.steps_after.items()}


def _dear(found: Any) -> Any:
    for provided in found.values():
        cost = provided.cost
        provided._steps = provided._steps  # cached: they are those of the right cost
        provided.cost = lambda state, cost=cost: 3 * cost(state)
    return found


def _doubled(found: dict[int, int]) -> dict[int, int]:
    return {state: 2 * key for state, key in found.items()}


def _without_handing_over(edges: Any) -> list[Any]:
    return [edge for edge in edges if edge[1][2]]


def _own_interactions(original: Any, self: Any, action: int) -> bool:
    alone = self._packed.op(action).agents == self._packed.human_bit
    return original(self, action) and alone


def _too_dear_soon(original: Any, self: Any, need: int, slack: int) -> Any:
    return original(self, need, slack // 2)


BUGS = (
    Bug(pattern_database, "backward", "doubled", returning(_doubled)),
    Bug(pattern_database, "_transitions", "joint actions are forgotten", wrapped(_own_moves)),
    Bug(Interactions, "is_interaction", "a joint action is none", wrapped(_own_interactions)),
    Bug(PrivateDistances, "explore", "the goal is two actions further", afterwards(steps_after=_two_further)),
    Bug(
        _Promise,
        "__init__",
        "help has to come two epochs earlier",
        afterwards(latest=lambda promise: promise.latest - 2),
    ),
    Bug(FirstInteractionOnTheWay, "opening", "nobody helps", replaced(_no_help)),
    Bug(FirstInteractionOnTheWay, "later", "nobody helps", wrapped(_no_help_later)),
    Bug(first_interaction, "survivors", "only the first is kept", returning(lambda few: few and few[:1])),
    Bug(Achievers, "epochs", "twice as many", returning(lambda epochs: 2 * epochs)),
    Bug(Achievers, "provided", "three times as dear", returning(_dear)),
    Bug(Achievers, "phases", "pi_H changes nothing outside", wrapped(lambda _, __, epochs: [(0, epochs)])),
    Bug(factory, "_reach", "a window has no time for robots", replaced(always(0))),
    Bug(
        AchieverCosts,
        "__call__",
        "what is achieved already is out of reach",
        returning(lambda key: key or INFINITE_KEY),
    ),
    Bug(AchieverAutomaton, "_changes", "nothing is handed over", returning(_without_handing_over)),
    Bug(AchieverAutomaton, "__init__", "nothing", afterwards(_flips=lambda self: type(self._flips)(0))),
    Bug(AchieverAutomaton, "distances", "half of what robots may pay is too much", wrapped(_too_dear_soon)),
    Bug(TransitionGraph, "__init__", "robots can't walk", wrapped(_slow_walks)),
)
