"""Ground actions by name."""

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence

from serendipity.model.task.actions import GroundAction


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
