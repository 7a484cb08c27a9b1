"""Agent automata: the product of all facts that only one agent's actions change.

A fact is *private* to an agent if he takes part in every action that changes it (a joint
action that hands him a kit included).  Since he does one action per epoch, the values of
his private facts follow an automaton whose arcs are his actions; what an action needs of
other facts is left to the rows of the program.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

from serendipity.model import GroundAction, Task
from verify.encodings.relevance import Relevant

MOST_STATES: Final = 2000
"""Facts are left out of an automaton, and become shared ones, rather than pass this size."""

Move = tuple[int, int]
"""An action's id and the state it leads to."""


@dataclass(slots=True)
class Automaton:
    """One agent's automaton; states are numbered, state 0 is the initial one.

    Attributes:
        agent: id.
        facts: the private facts that its states tell apart.
        states: the set of ``facts`` that is true in each state.
        moves: for each state the actions that its private facts allow.
    """

    agent: int
    facts: frozenset[int]
    states: list[frozenset[int]] = field(default_factory=list)
    moves: list[list[Move]] = field(default_factory=list)


def private_facts(task: Task, part: Relevant) -> dict[int, int]:
    """The agent to whom each private fact belongs; the human goes first where two could."""
    owners: dict[int, set[int]] = {}
    for i in part.actions:
        action = task.actions[i]
        for f in {*action.add, *action.delete} & part.facts:
            owners.setdefault(f, set(action.participants)).intersection_update(action.participants)
    order = sorted(range(len(task.agents)), key=lambda agent: (agent != task.human, agent))
    return {f: next(a for a in order if a in agents) for f, agents in owners.items() if agents}


def automata(task: Task, part: Relevant, units: Iterable[frozenset[int]]) -> tuple[Automaton, ...]:
    """The automaton of each agent, in the order of ids.

    Args:
        units: groups of facts that go into an automaton, or stay out, together.
    """
    owner = private_facts(task, part)
    result = []
    for agent in range(len(task.agents)):
        mine = frozenset(f for f, a in owner.items() if a == agent)
        actions = {i: task.actions[i] for i in part.actions if agent in task.actions[i].participants}
        result.append(_largest(task, part, agent, mine, actions, units))
    return tuple(result)


def _largest(
    task: Task,
    part: Relevant,
    agent: int,
    mine: frozenset[int],
    actions: Mapping[int, GroundAction],
    units: Iterable[frozenset[int]],
) -> Automaton:
    """The product of all private facts, or of as many units as stay below the limit."""
    whole = _explore(task, part, agent, mine, actions)
    if whole is not None:
        return whole
    pieces = [unit for unit in units if unit <= mine]
    grouped = frozenset().union(*pieces)
    pieces += [frozenset((f,)) for f in sorted(mine - grouped)]
    best = _explore(task, part, agent, frozenset(), actions)
    assert best is not None
    for piece in sorted(pieces, key=lambda piece: (-len(piece), min(piece))):
        larger = _explore(task, part, agent, best.facts | piece, actions)
        best = larger or best
    return best


def _explore(
    task: Task, part: Relevant, agent: int, facts: frozenset[int], actions: Mapping[int, GroundAction]
) -> Automaton | None:
    """The reachable states over ``facts``, or None if they are too many."""
    table = _by_first_fact(part, facts, actions)
    start = task.init & facts
    found = Automaton(agent, facts, [start])
    index = {start: 0}
    for state in found.states:  # grows while it is walked
        moves: list[Move] = []
        for f in (-1, *state):
            for i, pre, neg, add, delete in table.get(f, ()):
                if pre <= state and neg.isdisjoint(state):
                    target = (state - delete) | add
                    if target not in index:
                        if len(index) >= MOST_STATES:
                            return None
                        index[target] = len(index)
                        found.states.append(target)
                    moves.append((i, index[target]))
        found.moves.append(moves)
    return found


_Entry = tuple[int, frozenset[int], frozenset[int], frozenset[int], frozenset[int]]


def _by_first_fact(
    part: Relevant, facts: frozenset[int], actions: Mapping[int, GroundAction]
) -> dict[int, list[_Entry]]:
    """Actions projected on ``facts``, by one fact that they need (-1: none)."""
    needs = {i: facts.intersection(part.pre[i]) for i in actions}
    popular: dict[int, int] = {}
    for pre in needs.values():
        for f in pre:
            popular[f] = popular.get(f, 0) + 1
    table: dict[int, list[_Entry]] = {}
    for i, action in actions.items():
        pre = needs[i]
        first = min(pre, key=lambda f: (popular[f], f), default=-1)
        entry = (i, pre, facts.intersection(part.neg[i]), facts.intersection(action.add))
        table.setdefault(first, []).append((*entry, facts.intersection(action.delete)))
    return table
