"""Types: a name, or ``either`` of several names."""

from collections.abc import Mapping
from typing import Final

OBJECT: Final = "object"

Type = tuple[str, ...]
"""One of these names: an object of the type is of one of them."""

ANYTHING: Final[Type] = (OBJECT,)

MAX_LEVELS: Final = 128
"""Types above one another; who asks for what is above a type climbs them one by one."""


class Types:
    """A type hierarchy: who is a subtype of whom.

    Args:
        parents: by name, the type above it, without circles, and at most :data:`MAX_LEVELS` levels of
            them; every type but ``object`` is in it.
    """

    def __init__(self, parents: Mapping[str, Type]) -> None:
        self.parents = parents
        self._subtypes: dict[tuple[Type, Type], bool] = {}

    def _above(self, name: str) -> set[str]:
        """The type and all that are above it."""
        found, left = {OBJECT}, [name]
        while left:
            here = left.pop()
            if here not in found:
                found.add(here)
                left.extend(self.parents.get(here, ()))
        return found

    def __contains__(self, name: str) -> bool:
        return name in self.parents or name == OBJECT

    def is_subtype(self, kind: Type, expected: Type) -> bool:
        """Whether every object of type ``kind`` is of type ``expected``."""
        known = self._subtypes.get((kind, expected))
        if known is None:
            known = all(self._within(name, expected) for name in kind)
            self._subtypes[kind, expected] = known
        return known

    def _within(self, name: str, expected: Type) -> bool:
        if name in expected or OBJECT in expected:
            return True
        parents = self.parents.get(name)
        return parents is not None and self.is_subtype(parents, expected)

    def comparable(self, a: Type, b: Type) -> bool:
        """Whether an object may be of both: a name of one is above a name of the other."""
        return any(x in self._above(y) or y in self._above(x) for x in a for y in b)


def type_text(kind: Type) -> str:
    """A type as PDDL writes it."""
    return kind[0] if len(kind) == 1 else f"(either {' '.join(kind)})"
