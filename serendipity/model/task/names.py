"""Ground actions and facts by name."""

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Final

from serendipity.model.task.actions import GroundAction

_HINTS: Final = 3


def canonical_name(text: str) -> str:
    """An agent's or action's name as results write it: lower case, single blanks."""
    return " ".join(text.lower().split())


def named_alone(agents: Sequence[str], words: Iterable[str]) -> int | None:
    """Id of the only agent whose name is among the words of a fact; None where there is none, or several."""
    found = {agents.index(word) for word in words if word in agents}
    return found.pop() if len(found) == 1 else None


def unused(name: str, used: set[str]) -> str:
    """The name, or if it is used already one like it; it is used from now on."""
    candidate, number = name, 1
    while candidate in used:
        number += 1
        candidate = f"{name}_v{number}"
    used.add(candidate)
    return candidate


class ActionNames(Mapping[str, tuple[int, ...]]):
    """Ids of actions by name, looked up where the actions stand: in the order of their keys.

    A table of all names would take as long as reading a large task's first plan.

    Args:
        actions: ascending in ``GroundAction.key``.
    """

    def __init__(self, actions: Sequence[GroundAction]) -> None:
        self._actions = actions

    def __getitem__(self, name: str) -> tuple[int, ...]:
        key = tuple(name.split())
        found = []
        i = bisect_left(self._actions, key, key=lambda action: action.key)
        while i < len(self._actions) and self._actions[i].key == key:
            if self._actions[i].name == name:
                found.append(i)
            i += 1
        if not found:
            raise KeyError(name)
        return tuple(found)

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys(action.name for action in self._actions))

    def __len__(self) -> int:
        return sum(1 for _ in self)


def no_fact(name: str, facts: Iterable[str]) -> str:
    """The message that there is no such fact, with a few that are called much like it."""
    by_predicate: dict[str, list[str]] = {}
    for fact in facts:
        by_predicate.setdefault(fact.partition(" ")[0], []).append(fact)
    predicate, *words = name.split() or [""]
    like = get_close_matches(predicate, by_predicate, n=1)
    near = [fact for key in like for fact in by_predicate[key]]
    likely = [fact for fact in near if set(words).issubset(fact.split())] or near
    hint = f": perhaps {' or '.join(map(repr, likely[:_HINTS]))}" if likely else ""
    return f"there is no fact '{name}' in the task{hint}"
