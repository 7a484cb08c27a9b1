"""Bugs in what a mode allows, and in how its space is searched."""

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

from search.packed.joint_actions import NOTHING
from tests.verify.planted.bug import Bug, always, replaced, wrapped
from tests.verify.planted.roles import part


def _unchecked(self: Any, epoch: int, state: int) -> Iterable[Any]:
    return [option for _, option in part(self, "steps of pi_H")[epoch - 1]]


def _own_actions(self: Any, epoch: int, state: int) -> Iterable[Any]:
    return (NOTHING, *part(self, "successors").human(state))


def _only_waiting(self: Any, epoch: int, state: int) -> Iterable[Any]:
    return (NOTHING,)


def _joint_before(self: Any, epoch: int, state: int) -> Iterable[Any]:
    own = part(self, "successors").human(state)
    actions, names = part(self, "actions"), part(self, "names of pi_H")
    planned = (chosen for chosen in own if actions[chosen.actions[0]].name in names)
    return (NOTHING, *planned, *part(self, "successors").joint(state))


def _later_start(original: Any, self: Any, node: Any) -> Iterator[tuple[int, Any]]:
    for bound, opened in original(self, node):
        yield bound, opened._replace(start=opened.start + 1)


def _longer(original: Any, self: Any, **keywords: Any) -> None:
    original(self, **{**keywords, "max_window": keywords["max_window"] + 1})


def _one_epoch(original: Any, self: Any, **keywords: Any) -> None:
    original(self, **{**keywords, "max_window": 1})


def _shorter_horizon(original: Any, self: Any, **keywords: Any) -> None:
    horizon = keywords["horizon"]
    original(self, **{**keywords, "horizon": horizon and horizon - 1})


def _longer_horizon(original: Any, self: Any, **keywords: Any) -> None:
    horizon = keywords["horizon"]
    original(self, **{**keywords, "horizon": None if horizon is None else horizon + 1})


def _only_from_the_start(original: Any, self: Any, node: Any) -> Iterator[tuple[int, Any]]:
    if node.epoch == 0:
        yield from original(self, node)


def _late_end(original: Any, self: Any, node: Any, best: Any) -> None:
    known = best.node
    original(self, node, best)
    if best.node is not known:
        best.end -= 1


def _own_goal(original: Any, self: Any, **keywords: Any) -> None:
    original(self, **{**keywords, "goals": keywords["goals"][:1]})


def _first_is_best(original: Any, *arguments: Any) -> Iterator[Any]:
    yield from islice(original(*arguments), 1)


def _never_dear(self: Any, key: int, most_cost: int | None) -> bool:
    return False


def _dear_at_the_limit(self: Any, key: int, most_cost: int | None) -> bool:
    return most_cost is not None and self.scaled_cost(key) >= most_cost


def _ties_help(self: Any) -> bool:
    best, layout = part(self, "incumbent"), part(self, "layout of the call")
    if part(self, "predicted plan") is None or best.node is None:
        return False
    return bool(layout.cost(best.key) <= layout.cost(part(self, "best with robots idle").key))


BUGS = (
    Bug(
        "prefix that follows pi_H",
        "pi_H is followed where it is not applicable",
        replaced(_unchecked),
    ),
    Bug("prefix of actions of pi_H", "any own action is in pi_H", replaced(_own_actions)),
    Bug("prefix of actions of pi_H", "the human only waits before the window", replaced(_only_waiting)),
    Bug("prefix of actions of pi_H", "joint actions before the window", replaced(_joint_before)),
    Bug("opening a window", "it is said to start an epoch later", wrapped(_later_start)),
    Bug("opening a window", "in epoch 1 only", wrapped(_only_from_the_start)),
    Bug("ending a window", "it is said to end an epoch earlier", wrapped(_late_end)),
    Bug("limits of the window space", "max_window: an epoch more", wrapped(_longer)),
    Bug("limits of the window space", "max_window: always 1", wrapped(_one_epoch)),
    Bug("limits of the window space", "horizon: an epoch less", wrapped(_shorter_horizon)),
    Bug("limits of the window space", "horizon: an epoch more", wrapped(_longer_horizon)),
    Bug("whether a cost exceeds max_cost", "it never does", replaced(_never_dear)),
    Bug("whether a cost exceeds max_cost", "the limit itself does", replaced(_dear_at_the_limit)),
    Bug("limits of the unrestricted space", "horizon: an epoch less", wrapped(_shorter_horizon)),
    Bug("limits of the unrestricted space", "horizon: an epoch more", wrapped(_longer_horizon)),
    Bug("limits of the unrestricted space", "the robots' goal is forgotten", wrapped(_own_goal)),
    Bug("limits of the space of a fixed plan", "the robots' goal is forgotten", wrapped(_own_goal)),
    Bug("best-first search", "the first plan found is called optimal", wrapped(_first_is_best)),
    Bug("whether an answer is an opportunity", "a tie is one", replaced(_ties_help)),
    Bug("whether an answer is an opportunity", "nothing is one", replaced(always(False))),
    Bug("whether a given plan can be improved", "it is taken for optimal", replaced(always(False))),
)
