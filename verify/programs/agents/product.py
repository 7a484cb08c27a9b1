"""Agent automata: the product of all facts that only one agent's actions change.

A fact is *private* to an agent if it takes part in every action that changes it (a joint
action that hands it a kit included).  Since it does one action per epoch, the values of
its private facts follow an automaton whose arcs are its actions; what an action needs of
other facts is left to the rows of the program.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

from serendipity.model import Deadline, Task
from verify.base.execution import awake
from verify.base.relevance import Relevant
from verify.limits import limits

_SMALL: Final = 4
"""States of a small automaton for each fact of its largest group."""

_MANY: Final = 500_000
"""Moves from which on there may be no memory for more."""

_BYTES_A_MOVE: Final = 80

Move = tuple[int, int]
"""An action's id and the state it leads to."""

_Entry = tuple[int, frozenset[int], frozenset[int], frozenset[int], frozenset[int]]
"""An action's id, and what it needs, excludes, adds and deletes of some facts."""


@dataclass(slots=True)
class Automaton:
    """One agent's automaton; states are numbered, state 0 is the initial one.

    Attributes:
        facts: the private facts that its states tell apart.
        states: the set of ``facts`` that is true in each state.
        moves: for each state the actions that its private facts allow.
    """

    agent: int
    facts: frozenset[int]
    states: list[frozenset[int]] = field(default_factory=list)
    moves: list[list[Move]] = field(default_factory=list)


def private_facts(task: Task, part: Relevant, deadline: Deadline) -> dict[int, int]:
    """The agent to whom each private fact belongs; the human goes first where two could."""
    owners: dict[int, set[int]] = {}
    for i in deadline.each(part.actions):
        action = task.actions[i]
        for f in {*action.add, *action.delete} & part.facts:
            owners.setdefault(f, set(action.participants)).intersection_update(action.participants)
    order = sorted(range(len(task.agents)), key=lambda agent: (agent != task.human, agent))
    return {f: next(a for a in order if a in agents) for f, agents in deadline.each(owners.items()) if agents}


def automata(
    task: Task,
    part: Relevant,
    units: Iterable[frozenset[int]],
    deadline: Deadline,
    owner: Mapping[int, int] | None = None,
) -> tuple[Automaton, ...]:
    """The automaton of each agent, in the order of ids.

    Args:
        units: groups of facts that go into an automaton, or stay out, together.
        owner: whose facts are whose; None: as :func:`private_facts` has it.
    """
    owner = private_facts(task, part, deadline) if owner is None else owner
    result = []
    largest = max((len(variable.facts) for variable in task.variables), default=0)
    most = max(limits().automaton_states, limits().states_a_value * largest, 2)
    for agent in range(len(task.agents)):
        mine = frozenset(f for f, a in deadline.each(owner.items()) if a == agent)
        result.append(_Explorer(task, part, agent, most, deadline).largest(mine, units))
    return tuple(result)


class SmallAutomata:
    """Automata over few facts: each agent's largest group, and what many of their actions need.

    Args:
        units: groups of facts of which exactly one is true.
    """

    def __init__(
        self, task: Task, units: Iterable[frozenset[int]], deadline: Deadline, owner: Mapping[int, int]
    ) -> None:
        self._task, self._deadline = task, deadline
        groups = sorted(deadline.each(units), key=lambda unit: (-len(unit), min(unit)))
        self._mine: list[set[int]] = [set() for _ in task.agents]
        for f, agent in deadline.each(owner.items()):
            self._mine[agent].add(f)
        self._group = [next((unit for unit in groups if unit <= mine), frozenset()) for mine in self._mine]
        self._had: set[int] = set()

    def turn(self, part: Relevant) -> tuple[Automaton, ...] | None:
        """The automata of all agents with one more fact each; None: there is none left for the human.

        The human's is the one that most of their actions need, and each robot's the one that most of
        the actions need by which the human gets it; no turn before had it.
        """
        human, first = self._task.human, not self._had
        fact = self._next(self._asked(part, human, part.actions))
        if fact is None and not first:
            return None
        givers = [i for i in part.actions if fact in self._task.actions[i].add]
        result = []
        for agent in range(len(self._task.agents)):
            if agent != human:
                asked = self._asked(part, agent, givers) or self._asked(part, agent, part.actions)
                fact = self._next(asked)
            result.append(self._small(part, agent, () if fact is None else (fact,)))
        return tuple(result)

    def _next(self, asked: list[int]) -> int | None:
        """The first of some facts that no turn has had."""
        fact = next((f for f in asked if f not in self._had), None)
        self._had.add(-1 if fact is None else fact)
        return fact

    def _asked(self, part: Relevant, agent: int, actions: Iterable[int]) -> list[int]:
        """An agent's facts outside of their group that some of their actions need, the most wanted first."""
        facts = self._mine[agent] - self._group[agent]
        taking = (i for i in self._deadline.each(actions) if agent in self._task.actions[i].participants)
        count = Counter(f for i in taking for f in part.pre[i] if f in facts)
        return [f for f, _ in count.most_common()]

    def _small(self, part: Relevant, agent: int, others: tuple[int, ...]) -> Automaton:
        task, facts = self._task, self._group[agent]
        goals = (*task.goal.positive, *task.goal.negative)
        goal = [f for f in goals if f in self._mine[agent] and f not in facts]
        most = max(limits().automaton_states, _SMALL * len(facts))
        explorer = _Explorer(task, part, agent, most, self._deadline)
        found = (
            explorer.explore(facts.union(goal[:1], others))
            or explorer.explore(facts)
            or explorer.explore(frozenset())
        )
        assert found is not None
        return found


class _Explorer:
    """Makes automata of one agent."""

    def __init__(self, task: Task, part: Relevant, agent: int, most: int, deadline: Deadline) -> None:
        self._task = task
        self._part = part
        self._agent = agent
        actions = ((i, task.actions[i]) for i in deadline.each(part.actions))
        self._actions = {i: action for i, action in actions if agent in action.participants}
        self._most = most
        self._deadline = deadline

    def largest(self, mine: frozenset[int], units: Iterable[frozenset[int]]) -> Automaton:
        """The product of all private facts, or of as many units as stay below the limit."""
        whole = self.explore(mine)
        if whole is not None:
            return whole
        pieces = [unit for unit in self._deadline.each(units) if unit <= mine]
        grouped = frozenset().union(*pieces)
        pieces += [frozenset((f,)) for f in sorted(mine - grouped)]
        # Who waits for nothing any more is told apart, whatever else is left out: their waiting is free.
        best = self.explore(mine & awake(self._task)) or self.explore(frozenset())
        assert best is not None
        for piece in sorted(pieces, key=lambda piece: (-len(piece), min(piece))):
            larger = self.explore(best.facts | piece)
            if larger is None and sum(map(len, best.moves)) > limits().automaton_moves:
                break
            best = larger or best
        return best

    def explore(self, facts: frozenset[int]) -> Automaton | None:
        """The automaton of the reachable states over ``facts``, or None if they are too many."""
        table = self._by_first_fact(facts)
        start = self._task.init & facts
        found = Automaton(self._agent, facts, [start])
        index = {start: 0}
        size, enough = 0, _MANY
        for state in found.states:  # grows while it is walked
            self._deadline.check()
            moves: list[Move] = []
            for f in (-1, *state):
                for i, pre, neg, add, delete in table.get(f, ()):
                    if pre <= state and neg.isdisjoint(state):
                        target = (state - delete) | add
                        if target not in index:
                            if len(index) >= self._most:
                                return None
                            index[target] = len(index)
                            found.states.append(target)
                        moves.append((i, index[target]))
            found.moves.append(moves)
            size += len(moves)
            if size > enough:  # there has to be memory for as many again
                self._deadline.require(size * _BYTES_A_MOVE)
                enough = 2 * size
        return found

    def _by_first_fact(self, facts: frozenset[int]) -> dict[int, list[_Entry]]:
        """Actions projected on ``facts``, by one fact that they need (-1: none)."""
        needs = {i: facts.intersection(self._part.pre[i]) for i in self._deadline.each(self._actions)}
        popular = Counter(f for pre in self._deadline.each(needs.values()) for f in pre)
        table: dict[int, list[_Entry]] = {}
        for i, action in self._deadline.each(self._actions.items()):
            pre = needs[i]
            first = min(pre, key=lambda f: (popular[f], f), default=-1)
            entry = (i, pre, facts.intersection(self._part.neg[i]), facts.intersection(action.add))
            table.setdefault(first, []).append((*entry, facts.intersection(action.delete)))
        return table
