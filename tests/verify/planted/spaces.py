"""Bugs in what a mode allows, and in how its space is searched."""

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

from search.packed.cost_vector import CostLayout
from search.packed.joint_actions import NOTHING
from search.spaces.fixed_human_plan import FixedHumanPlan
from search.spaces.unrestricted import Unrestricted
from search.spaces.windowed import AnyOfPlan, InLayers, Windowed
from search.strategies import human_plan, outcome, windows
from tests.verify.planted.bug import Bug, always, asked, replaced, returning, wrapped


def _unchecked(self: Any, epoch: int, state: int) -> Iterable[Any]:
    return [option for _, option in self._layers[epoch - 1]]


def _own_actions(self: Any, epoch: int, state: int) -> Iterable[Any]:
    return (NOTHING, *self._successors.human(state))


def _only_waiting(self: Any, epoch: int, state: int) -> Iterable[Any]:
    return (NOTHING,)


def _joint_before(self: Any, epoch: int, state: int) -> Iterable[Any]:
    own = self._successors.human(state)
    actions, names = self._actions, self._planned
    planned = (chosen for chosen in own if actions[chosen.actions[0]].name in names)
    return (NOTHING, *planned, *self._successors.joint(state))


def _later_start(original: Any, self: Any, node: Any) -> Iterator[tuple[int, Any]]:
    for bound, opened in original(self, node):
        yield bound, opened._replace(start=opened.start + 1)


def _only_from_the_start(original: Any, self: Any, node: Any) -> Iterator[tuple[int, Any]]:
    if node.epoch == 0:
        yield from original(self, node)


def _late_end(original: Any, self: Any, node: Any, option: Any, best: Any) -> None:
    known = best.node
    original(self, node, option, best)
    if best.node is not known:
        best.end -= 1


def _never_dear(self: Any, key: int, most_cost: int | None) -> bool:
    return False


def _dear_at_the_limit(self: Any, key: int, most_cost: int | None) -> bool:
    return most_cost is not None and self.scaled_cost(key) >= most_cost


def _ties_help(self: Any) -> bool:
    best, layout = self.best, self.keys
    if self.plan is None or best.node is None:
        return False
    return bool(layout.cost(best.key) <= layout.cost(self.idle.key))


BUGS = (
    Bug(InLayers, "options", "pi_H is followed where it is not applicable", replaced(_unchecked)),
    Bug(AnyOfPlan, "options", "any own action is in pi_H", replaced(_own_actions)),
    Bug(AnyOfPlan, "options", "the human only waits before the window", replaced(_only_waiting)),
    Bug(AnyOfPlan, "options", "joint actions before the window", replaced(_joint_before)),
    Bug(Windowed, "_open", "it is said to start an epoch later", wrapped(_later_start)),
    Bug(Windowed, "_open", "in epoch 1 only", wrapped(_only_from_the_start)),
    Bug(Windowed, "_end", "it is said to end an epoch earlier", wrapped(_late_end)),
    Bug(Windowed, "__init__", "max_window: an epoch more", asked(max_window=lambda most: most + 1)),
    Bug(Windowed, "__init__", "max_window: always 1", asked(max_window=always(1))),
    Bug(Windowed, "__init__", "horizon: an epoch less", asked(horizon=lambda last: last and last - 1)),
    Bug(Windowed, "__init__", "horizon: an epoch more", asked(horizon=lambda last: last and last + 1)),
    Bug(CostLayout, "exceeds", "it never does", replaced(_never_dear)),
    Bug(CostLayout, "exceeds", "the limit itself does", replaced(_dear_at_the_limit)),
    Bug(Unrestricted, "__init__", "the robots' goal is forgotten", asked(goals=lambda goals: goals[:1])),
    Bug(FixedHumanPlan, "__init__", "the robots' goal is forgotten", asked(goals=lambda goals: goals[:1])),
    Bug(
        windows,
        "best_first",
        "the first plan found is called optimal",
        returning(lambda found: islice(found, 1)),
    ),
    Bug(outcome, "helps", "a tie is one", replaced(_ties_help)),
    Bug(outcome, "helps", "nothing is one", replaced(always(False))),
    Bug(human_plan, "_may_turn_at_once", "whatever is asked", replaced(always(True))),
)
