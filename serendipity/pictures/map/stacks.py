"""Things that stand on each other, where nobody goes anywhere: one place, and towers in it.

What is on what is told by facts of one predicate, of two things each, in the order in which one says it:
``on a b``.  It is one that actions change, that no thing has twice, and in which no tower is a circle.  What
no action makes true together with it says that a thing stands on the ground (``ontable a``), or, where an
agent is named, too, that the agent has it (``holding robot a``).
"""

from collections import defaultdict
from collections.abc import Iterable
from typing import Final

import networkx as nx

from serendipity.model import Task
from serendipity.pictures.map.names import Parts, parts

Pairs = dict[int, tuple[str, str]]
"""By fact id: what is on something, and what that is."""

_LEAST: Final = 2
"""Things that others may be on: with one there are no towers."""


class Stacks:
    """What is on what in a task.

    Attributes:
        on: by fact id.
        ground: by fact id, what stands on the ground.
        held: by fact id, what is held, and by which agent.
    """

    def __init__(self, task: Task) -> None:
        words = [parts(fact) for fact in task.facts]
        self.on: Pairs = {}
        self.ground: dict[int, str] = {}
        self.held: dict[int, tuple[str, int]] = {}
        pairs: dict[str, Pairs] = defaultdict(dict)
        changed = {fact for action in task.actions for fact in (*action.add, *action.delete)}
        for fact, (predicate, *rest) in enumerate(words):
            if len(rest) == 2 and not set(rest).intersection(task.agents):
                pairs[predicate][fact] = rest[0], rest[1]
        found = {p: told for p, told in pairs.items() if _are_towers(task, told, changed)}
        if found:
            self.on = max(found.values(), key=len)
            self._find_rest(task, words)

    @property
    def things(self) -> list[str]:
        """All that is on something, or under it."""
        return list(dict.fromkeys(thing for pair in self.on.values() for thing in pair))

    def _find_rest(self, task: Task, words: list[Parts]) -> None:
        agents = {name: i for i, name in enumerate(task.agents)}
        movable = {upper for upper, _ in self.on.values()}
        together = _together(task, self.on)
        added = {fact for action in task.actions for fact in action.add}
        for fact, (_, *rest) in enumerate(words):
            who = [agents[word] for word in rest if word in agents]
            things = [word for word in rest if word in movable]
            if fact in together or fact not in added or len(things) != 1:
                continue
            if len(rest) == 2 and who:
                self.held[fact] = things[0], who[0]
            elif len(rest) == 1:
                self.ground[fact] = things[0]
        spoken = {words[fact][0] for fact in together}
        self.ground = {fact: thing for fact, thing in self.ground.items() if words[fact][0] not in spoken}
        self.held = {fact: pair for fact, pair in self.held.items() if words[fact][0] not in spoken}


def _are_towers(task: Task, told: Pairs, changed: set[int]) -> bool:
    """Whether pairs of things are what is on what."""
    graph = nx.DiGraph(told[fact] for fact in task.init & told.keys())
    under = {lower for _, lower in told.values()}
    return (
        changed.issuperset(told)
        and len(under) >= _LEAST
        and under.issuperset(upper for upper, _ in told.values())
        and all(degree <= 1 for _, degree in graph.out_degree)
        and nx.is_directed_acyclic_graph(graph)
    )


def _together(task: Task, on: Pairs) -> set[int]:
    """Facts about a thing that hold while it is on something: at first, or by what puts it there."""
    found: set[int] = set()
    states: Iterable[frozenset[int]] = (task.init, *(frozenset(action.add) for action in task.actions))
    for facts in states:
        uppers = {on[fact][0] for fact in facts & on.keys()}
        found.update(f for f in facts - on.keys() if uppers.intersection(parts(task.facts[f])[1:]))
    return found
