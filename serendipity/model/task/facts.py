"""Facts by the names that callers write."""

from collections.abc import Iterable, Sequence

from serendipity.model.errors import UsageError
from serendipity.model.task.actions import Condition
from serendipity.model.task.names import no_fact
from serendipity.model.task.task import canonical_name


class Facts:
    """Ids of facts by name."""

    def __init__(self, names: Sequence[str]) -> None:
        self._ids = {name: fact for fact, name in enumerate(names)}

    def id(self, name: str) -> int:
        """The id of a fact; a UsageError where there is no such fact."""
        fact = self._ids.get(canonical_name(name))
        if fact is None:
            raise UsageError(no_fact(canonical_name(name), self._ids))
        return fact

    def condition(self, literals: Iterable[str]) -> Condition:
        """The conjunction of literals, ``!`` in front of those to be false."""
        given = [*literals]
        positive = sorted(self.id(name) for name in given if not name.startswith("!"))
        negative = sorted(self.id(name[1:]) for name in given if name.startswith("!"))
        return Condition(tuple(positive), tuple(negative))

    def seen(self, state: frozenset[int], facts: Iterable[tuple[str, bool]]) -> frozenset[int]:
        """A state in which some facts are true, or false, as somebody has seen them.

        Raises:
            UsageError: there is no such fact, or something else than true or false is said of it.
        """
        found = set(state)
        for name, true in facts:
            fact = self.id(name)
            if not isinstance(true, bool):
                raise UsageError(f"{name}: expected true or false, got {true!r:.50}")
            found.add(fact) if true else found.discard(fact)
        return frozenset(found)
