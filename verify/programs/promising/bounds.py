"""Bounds on what robots must have spent before something happens, and may have spent for it to be of use.

The first bound is computed as Knuth generalised Dijkstra's algorithm: what an action needs (a state of each
participant, and facts outside their automata) is there once the dearest of its parts is, and the action's own
price comes on top, since it is paid later than any of them.  Nothing is ever deleted, and facts of agents who
are not looked at are there from the start.

The second one goes the other way round: from the human's actions, each with what robots may have spent when
it takes place, back along robots' paths and the facts that they change.  A robot's move after which nothing
that it did is of use to anybody is on no plan worth looking at: without it the others can do the same.

With prices of 1 the bounds are the earliest and the latest epoch.  All that comes at the same value is looked
at together.
"""

from typing import Final

import numpy as np

from serendipity.model import Deadline
from verify.packed.edges import Rows
from verify.packed.layout import Ints
from verify.programs.promising.arrays import Actions, Arcs, Mask, in_order

NEVER: Final = -1
"""Of no use, however little was spent."""


class Spending:
    """Least spending of some agents before each state, literal and action.

    Args:
        arcs: all moves that are left.
        counted: whether an agent's spending counts, by id.
        offered: the actions in which those take part who are left out; what they change is free.

    Attributes:
        states: for each state what was spent on the way there; ``far``: it is not reached.
        ready: for each action what was spent before it could take place; ``far``: it can't.
        parts: by agent and action, what was spent before the agent is where it starts.
    """

    def __init__(
        self, actions: Actions, arcs: Arcs, counted: Mask, price: Ints, offered: Mask, deadline: Deadline
    ) -> None:
        self._actions, self._arcs, self._price, self._counted = actions, arcs, price, counted
        self._far = far = actions.far
        count = len(price)
        self._mine = np.flatnonzero(counted[arcs.agent])
        self._leaving = Rows.by(arcs.source[self._mine], arcs.states, self._mine)
        self._of_action = Rows.by(arcs.action[self._mine], count, self._mine)
        self.free = actions.initially.copy()
        self.free[actions.changes.at(np.flatnonzero(offered))] = True
        literals = len(actions.initially)
        self.literals = np.where(self.free, 0, far)
        self.states = np.full(arcs.states, far)
        self.ready = np.full(count, far)
        self.parts = np.full((len(counted), count), far)
        keys, needs = actions.needs.keys(), actions.needs.items
        lacking = ~self.free[needs]
        self._waiting = Rows.by(needs[lacking], literals, keys[lacking])
        missing = np.bincount(keys[lacking], minlength=count)
        takers, owners = actions.participants.keys(), actions.participants.items
        alone = counted[owners] | ~offered[takers]
        self._missing = missing + np.bincount(takers[alone], minlength=count)
        self._run(deadline)

    def facts(self) -> Ints:
        """For each action what was spent before the facts are there that it needs outside of automata."""
        return self._actions.needs.most(self.literals)

    def made(self, by: Mask) -> Ints:
        """For each literal what was spent once an action that is among some makes it; 0 if it is true."""
        changes, done = self._actions.changes, by & (self.ready < self._far)
        makers = changes.keys()
        chosen = done[makers] & self._actions.needed[changes.items]
        found = np.where(self._actions.initially, 0, self._far)
        after = self.ready[makers[chosen]] + self._price[makers[chosen]]
        np.minimum.at(found, changes.items[chosen], after)
        return found

    def partners(self, but: int) -> Ints:
        """For each action what was spent before all who take part, without one, are where it starts."""
        taking, owner = self._actions.participants.keys(), self._actions.participants.items
        others = self._counted[owner] & (owner != but)
        least = np.zeros(len(self.ready), np.int64)
        np.maximum.at(least, taking[others], self.parts[owner[others], taking[others]])
        return least

    def arcs(self) -> Ints:
        """For each move what was spent once it is done."""
        arcs = self._arcs
        before = np.maximum(self.states[arcs.source], self.ready[arcs.action])
        return np.where(before >= self._far, self._far, before + self._price[arcs.action])

    def _run(self, deadline: Deadline) -> None:
        first = self._arcs.first
        self.states[first[:-1][self._counted]] = 0
        seen = np.zeros(len(self.states), bool), self.free.copy()
        for value, (here, known) in in_order((self.states, self.literals), seen, self._far, deadline):
            self._settle(value, self._leaving.at(here), self._waiting.at(known), seen[0])

    def _settle(self, value: int, leaving: Ints, lacked: Ints, seen: Mask) -> None:
        """Moves that start now, and actions whose needs are there now, once for each need."""
        arcs, count = self._arcs, len(self.ready)
        parts = np.unique(arcs.agent[leaving] * count + arcs.action[leaving])
        agent, action = np.divmod(parts, count)
        new = self.parts[agent, action] == self._far
        self.parts[agent[new], action[new]] = value
        there = np.concatenate((action[new], lacked))
        np.subtract.at(self._missing, there, 1)
        there = np.unique(there)
        ready = there[(self._missing[there] == 0) & (self.ready[there] == self._far)]
        self.ready[ready] = value
        possible = leaving[self.ready[arcs.action[leaving]] < self._far]
        blocked = self._of_action.at(ready)
        going = np.concatenate((possible, blocked[seen[arcs.source[blocked]]]))
        np.minimum.at(self.states, arcs.target[going], value + self._price[arcs.action[going]])
        makers = np.repeat(ready, np.diff(self._actions.changes.start)[ready])
        made = self._actions.changes.at(ready)
        wanted = self._actions.needed[made]
        np.minimum.at(self.literals, made[wanted], value + self._price[makers[wanted]])


class Use:
    """Most that may have been spent when a robot is in a state, or has done an action, and is of use.

    Args:
        arcs: all moves that are left.
        robots: whether an agent is a robot, by id.
        watched: whether an agent goes on to the end, by id.
        price: what an action takes of what may be spent.
        literals: by literal, what may have been spent when it becomes true.
        joint: by action the same afterwards, for the human's joint actions; :data:`NEVER` elsewhere.
        end: what may have been spent at the end.
    """

    def __init__(
        self,
        actions: Actions,
        arcs: Arcs,
        robots: Mask,
        watched: Mask,
        price: Ints,
        literals: Ints,
        joint: Ints,
        end: int,
        deadline: Deadline,
    ) -> None:
        self._actions, self._arcs, self._price, self._end = actions, arcs, price, end
        self._watched = watched
        mine = np.flatnonzero(robots[arcs.agent])
        count = len(price)
        self._into = Rows.by(arcs.target[mine], arcs.states, mine)
        self._of_action = Rows.by(arcs.action[mine], count, mine)
        done = np.diff(self._of_action.start) > 0
        makers = actions.changes.keys()
        robots_make = done[makers]
        self._makers = Rows.by(actions.changes.items[robots_make], len(literals), makers[robots_make])
        self.states = np.full(arcs.states, NEVER)
        self._literals = literals.copy()
        self._used = np.where(done, joint, NEVER)
        seen_to = arcs.action[mine[watched[arcs.agent[mine]]]]
        self._used[seen_to] = np.maximum(self._used[seen_to], end)
        self._run(deadline)

    def arcs(self) -> Ints:
        """For each move what may have been spent once it is done; :data:`NEVER`: it is of no use."""
        arcs = self._arcs
        use = np.maximum(self._used[arcs.action], self.states[arcs.target])
        return np.where(self._watched[arcs.agent], self._end, use)

    def _run(self, deadline: Deadline) -> None:
        kinds = self.states, self._literals, self._used
        seen = [np.zeros(len(values), bool) for values in kinds]
        moved = np.zeros(len(self._used), bool)
        for value, (states, literals, used) in in_order(kinds, seen, NEVER, deadline, np.maximum):
            self._offer(self._used, self._makers.at(literals), value)
            arcs = np.concatenate((self._into.at(states), self._of_action.at(used)))
            self._before(value, arcs, moved)

    def _before(self, value: int, arcs: Ints, moved: Mask) -> None:
        """Moves are of use: so is what they need."""
        action = self._arcs.action[arcs]
        np.maximum.at(self.states, self._arcs.source[arcs], np.maximum(value - self._price[action], NEVER))
        new = np.unique(action[~moved[action]])
        moved[new] = True
        needs = self._actions.needs
        left = np.repeat(value - self._price[new], np.diff(needs.start)[new])
        np.maximum.at(self._literals, needs.at(new), np.maximum(left, NEVER))
        joint = new[self._actions.joint[new]]
        self._offer(self._used, joint, value)

    @staticmethod
    def _offer(values: Ints, keys: Ints, value: int) -> None:
        values[keys] = np.maximum(values[keys], value)
