"""A team's moves as arrays, and ways over them.

Moves of all agents are numbered through, ordered by agent and state; states are numbered through, too.
Literals are numbers: ``f`` says that a fact is true, ``f`` plus the number of facts that it is false.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, pairwise

import numpy as np
from numpy.typing import NDArray

from serendipity.model import Deadline
from verify.packed.edges import Rows
from verify.packed.layout import Ints
from verify.programs.agents.product import Move
from verify.programs.promising.team import TeamMoves

Mask = NDArray[np.bool_]


class Actions:
    """What a team's actions need and change, by id.

    Attributes:
        price: what each adds to the objective.
        needs: literals outside of its participants' automata.
        changes: literals that it makes true.
        initially: whether a literal is true initially.
        needed: whether some action needs a literal of its fact.
    """

    def __init__(self, team: TeamMoves) -> None:
        task, each = team.task, team.deadline.each
        self._count, self.facts = len(task.actions), len(task.facts)
        self._ids = np.fromiter(team.pre, np.int64, len(team.pre))
        self.far = team.far
        self.price = np.array(team.price, np.int64)
        ground = [task.actions[i] for i in each(team.pre)]
        self.needs = self._literals(list(team.pre.values()), [team.neg[i] for i in team.pre])
        self.changes = self._literals([each.add for each in ground], [each.delete for each in ground])
        self.participants = self._rows([each.participants for each in ground])
        self.joint: Mask = np.diff(self.participants.start) > 1
        true, needed = which(task.init, self.facts), which(team.needed, self.facts)
        self.initially: Mask = np.concatenate((true, ~true))
        self.needed: Mask = np.concatenate((needed, needed))

    def _rows(self, lists: Sequence[Sequence[int]]) -> Rows:
        """Lists of the actions that matter, as rows of all actions."""
        rows = Rows.of(lists)
        return Rows.by(self._ids[rows.keys()], self._count, rows.items)

    def _literals(self, true: Sequence[Sequence[int]], false: Sequence[Sequence[int]]) -> Rows:
        positive, negative = Rows.of(true), Rows.of(false)
        keys = np.concatenate((self._ids[positive.keys()], self._ids[negative.keys()]))
        items = np.concatenate((positive.items, negative.items + self.facts))
        return Rows.by(keys, self._count, items)


class Arcs:
    """The moves that are left, as arrays.

    Args:
        first: for each agent the number of their state 0; then the number of all states.
        source: where each move starts.
        action: its action.
        target: where it leads.
        agent: whose it is.
    """

    def __init__(self, first: Ints, source: Ints, action: Ints, target: Ints, agent: Ints) -> None:
        self.first, self.agent = first, agent
        self.source, self.action, self.target = source, action, target

    @classmethod
    def of(cls, team: TeamMoves) -> "Arcs":
        """All moves of a team."""
        first = np.concatenate(([0], np.cumsum([len(moves) for moves in team.moves])))
        sources, actions, targets, agents = [], [], [], []
        for k, moves in enumerate(team.moves):
            sizes = np.fromiter(map(len, team.deadline.each(moves)), np.int64, len(moves))
            pairs = chain.from_iterable(chain.from_iterable(team.deadline.each(moves)))
            both = np.fromiter(pairs, np.int64, 2 * int(sizes.sum())).reshape(-1, 2)
            sources.append(np.repeat(np.arange(len(moves)) + first[k], sizes))
            actions.append(both[:, 0])
            targets.append(both[:, 1] + first[k])
            agents.append(np.full(len(both), k))
        return cls(first, *map(np.concatenate, (sources, actions, targets, agents)))

    @property
    def states(self) -> int:
        """How many states there are."""
        return int(self.first[-1])

    def only(self, mask: Mask) -> "Arcs":
        """Some of them."""
        chosen = self.source[mask], self.action[mask], self.target[mask], self.agent[mask]
        return Arcs(self.first, *chosen)

    def lists(self, agent: int) -> list[list[Move]]:
        """An agent's moves, state by state."""
        mine = self.only(self.agent == agent)
        first, end = int(self.first[agent]), int(self.first[agent + 1])
        moves = list(zip(mine.action.tolist(), (mine.target - first).tolist(), strict=True))
        start = np.searchsorted(mine.source, np.arange(first, end + 1)).tolist()
        return [moves[a:b] for a, b in pairwise(start)]


class HumanWays:
    """The human's ways over some moves, where what an action needs may have to be made by themselves first.

    Args:
        moves: where each starts, its action, where it leads, and its price.
        lacking: the actions that need what they have to make, and the literals that these are.
        start: for each state what is paid there at first, or ``far``.
        left: what is left to be paid from each state; where all of it exceeds ``limit`` nobody goes.
        limit: what may be paid.

    Attributes:
        done: for each state the least price of a way there, or ``far``.
        ready: for each action what is paid before the facts are there that they have to make.
    """

    def __init__(
        self,
        moves: tuple[Ints, Ints, Ints, Ints],
        lacking: tuple[Ints, Ints],
        actions: Actions,
        start: Ints,
        left: Ints,
        limit: int,
        deadline: Deadline,
    ) -> None:
        self._source, self._action, self._target, self._weight = moves
        self._actions, self._most, count = actions, limit - left, len(actions.price)
        self._far = far = actions.far
        self.done = start.copy()
        self._missing = np.bincount(lacking[0], minlength=count)
        self.ready = np.where(self._missing, far, 0)
        self._wanted = which(lacking[1].tolist(), len(actions.initially))
        self._waiting = Rows.by(lacking[1], len(self._wanted), lacking[0])
        self._literals = np.full(len(self._wanted), far)
        self._leaving = Rows.by(self._source, len(start))
        self._of_action = Rows.by(self._action, count)
        self._run(deadline)

    def _run(self, deadline: Deadline) -> None:
        kinds = self.done, self._literals
        seen = [np.zeros(len(values), bool) for values in kinds]
        for value, (here, made) in in_order(kinds, seen, self._far, deadline):
            there = self._waiting.at(made)
            np.subtract.at(self._missing, there, 1)
            new = np.unique(there[self._missing[there] == 0])
            self.ready[new] = value
            blocked = self._of_action.at(new)
            leaving = self._leaving.at(here)
            self._go(value, np.concatenate((leaving, blocked[seen[0][self._source[blocked]]])))

    def _go(self, value: int, moves: Ints) -> None:
        moves = moves[self.ready[self._action[moves]] <= value]
        after, total = self._target[moves], value + self._weight[moves]
        kept = total <= self._most[after]
        np.minimum.at(self.done, after[kept], total[kept])
        makers = np.unique(self._action[moves[kept]])
        facts = self._actions.changes.at(makers)
        prices = np.repeat(value + self._actions.price[makers], np.diff(self._actions.changes.start)[makers])
        wanted = self._wanted[facts]
        np.minimum.at(self._literals, facts[wanted], prices[wanted])


def in_order(
    kinds: Sequence[Ints], seen: Sequence[Mask], none: int, deadline: Deadline, first: np.ufunc = np.minimum
) -> Iterator[tuple[int, list[Ints]]]:
    """The values of nodes of several kinds one by one, with the nodes of each kind that have them.

    Args:
        kinds: by kind, the nodes' values, which may change on the way if they have not come yet.
        seen: likewise, whether a node has come.
        none: of a node that does not come.
        first: whether the least value comes first or the greatest.
    """
    while True:
        deadline.check()
        opened = [np.where(done, none, values) for done, values in zip(seen, kinds, strict=True)]
        value = int(first.reduce([first.reduce(values, initial=none) for values in opened]))
        if value == none:
            return
        here = [np.flatnonzero(values == value) for values in opened]
        for done, now in zip(seen, here, strict=True):
            done[now] = True
        yield value, here


def which(ids: Iterable[int], count: int) -> Mask:
    """A mask of some numbers below ``count``."""
    mask = np.zeros(count, bool)
    mask[list(ids)] = True
    return mask
