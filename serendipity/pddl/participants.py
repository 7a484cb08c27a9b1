"""Participants of ground actions, in each layout."""

from collections.abc import Iterable, Sequence
from functools import cache
from itertools import chain, repeat

from serendipity.pddl.grounding.instantiate import Participants
from serendipity.pddl.parsing.lifted import Key, Unit
from serendipity.pddl.parsing.tree import listed, quoted


def by_owner(agent: int) -> Participants:
    """The owner of the file, alone."""
    return lambda keys: repeat((agent,), len(keys))


def by_arguments(agents: Sequence[str]) -> Participants:
    """The agents among the arguments; nobody where there is none."""
    numbers = {name: i for i, name in enumerate(agents)}
    everyone = frozenset(agents)

    @cache
    def ids(present: frozenset[str]) -> tuple[int, ...]:
        return tuple(sorted(map(numbers.__getitem__, present)))

    return lambda keys: [ids(everyone.intersection(key[1:])) for key in keys]


def by_first_argument(agents: Sequence[str]) -> Participants:
    """The first argument alone (MA-PDDL's ``:agent``), which is one of the agents."""
    ids = {name: (i,) for i, name in enumerate(agents)}
    return lambda keys: [ids[key[1]] for key in keys]


def by_name_parts(agents: Sequence[str], unit: Unit) -> Participants:
    """The agents whose names occur among the parts of the name, split at ``_`` and blanks.

    An agent whose own name has several parts (``robot_2``) occurs where they stand in
    a row; of two names that start at the same part the longer one counts.

    Raises:
        InputError: when called, if no agent occurs in an action's name.
    """
    finder = _NameFinder(agents)

    def participants(keys: Sequence[Key]) -> Iterable[tuple[int, ...]]:
        telling = frozenset(filter(finder.agents_in, {*chain.from_iterable(keys)}))
        for key in keys:
            found = finder.named(telling.intersection(key))
            if not found:
                line = next(s.line for s in unit.domain.schemas if s.name == key[0])
                message = f"no agent's name ({listed(agents)}) occurs in its name"
                raise unit.domain_error(f"joint action {quoted(' '.join(key))}: {message}", line)
            yield found

    return participants


def agents_named(agents: Sequence[str], name: str) -> tuple[int, ...]:
    """The ids of the agents whose names occur in an action's name."""
    return _NameFinder(agents).named(name.split())


class _NameFinder:
    def __init__(self, agents: Sequence[str]) -> None:
        patterns = ((_parts(name), agent) for agent, name in enumerate(agents))
        self._patterns = sorted(patterns, key=lambda pattern: -len(pattern[0]))
        self.agents_in = cache(self._agents_in)
        self._found: dict[frozenset[str], tuple[int, ...]] = {}

    def named(self, words: Iterable[str]) -> tuple[int, ...]:
        """The agents that occur in some words, ascending."""
        words = frozenset(words)
        if words not in self._found:
            self._found[words] = tuple(sorted(frozenset().union(*map(self.agents_in, words))))
        return self._found[words]

    def _agents_in(self, word: str) -> frozenset[int]:
        parts = _parts(word)
        found = set()
        start = 0
        while start < len(parts):
            length = 1
            for pattern, agent in self._patterns:
                if parts[start : start + len(pattern)] == pattern:
                    found.add(agent)
                    length = len(pattern)
                    break
            start += length
        return frozenset(found)


def _parts(word: str) -> list[str]:
    return word.replace("_", " ").split()
