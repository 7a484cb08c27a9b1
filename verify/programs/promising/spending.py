"""What must be spent, at least, before a state, a fact or an action of some agents comes about.

Costs are bounded from below as Knuth generalised Dijkstra's algorithm: what is needed for an action (a
state of each participant, and facts outside their automata) is there once the dearest of its parts is, and
the action's own price comes on top, since it is paid later than any of them.  Nothing is ever deleted, and
facts of agents who are not looked at are there from the start.  With prices of 1 the bound is the earliest
epoch.
"""

from collections.abc import Callable, Collection, Iterable
from heapq import heappop, heappush

from verify.programs.agents.product import Move
from verify.programs.promising.team import Team

_Event = tuple[int, int, int, int]
"""A value, a kind, and what it is about."""

_STATE, _TRUE, _FALSE = 0, 1, 2


class Spending:
    """The bounds, for some agents.

    Args:
        team: automata and needs.
        agents: those whose spending counts.
        price: of each action.
        offered: the actions that those who are left out take part in; what they change is free.

    Attributes:
        states: by agent, for each state what was spent on the way there; ``far``: it is not reached.
        ready: what was spent before an action could take place; an action that can't is missing.
    """

    def __init__(
        self, team: Team, agents: Collection[int], price: Callable[[int], int], offered: Collection[int] = ()
    ) -> None:
        self._team, self._far = team, team.far
        self._price = price
        self.states = {k: [self._far] * len(team.moves[k]) for k in agents}
        self.ready: dict[int, int] = {}
        self._free_true = set(team.task.init)
        self._free_false: set[int] = set()
        for i in team.deadline.each(offered):
            self._free_true.update(team.task.actions[i].add)
            self._free_false.update(team.task.actions[i].delete)
        self._offered = offered
        self._true: dict[int, int] = {}
        self._false: dict[int, int] = {}
        self._missing: dict[int, int] = {}
        self._partners: dict[int, set[int]] = {}
        self._waiting: tuple[dict[int, list[int]], dict[int, list[int]]] = {}, {}
        self._blocked: dict[int, list[tuple[int, int]]] = {}
        self._events: list[_Event] = []
        self._at: dict[tuple[int, int], int] = {}
        self._run()

    def before(self, action: int) -> int:
        """What was spent before an action that others need is there; ``far``: it can't take place."""
        return self.ready.get(action, self._far)

    def facts(self, action: int) -> int:
        """What was spent before the facts are there that an action needs outside of automata."""
        team, least = self._team, 0
        for f in team.pre[action]:
            if f not in self._free_true:
                least = max(least, self._true.get(f, self._far))
        for f in team.neg[action]:
            if f in team.task.init and f not in self._free_false:
                least = max(least, self._false.get(f, self._far))
        return least

    def made(self, actions: Iterable[int]) -> tuple[dict[int, int], dict[int, int]]:
        """What was spent once one of some actions makes a fact true, or false; 0 if it is so."""
        task, needed = self._team.task, self._team.needed
        true = dict.fromkeys(needed & task.init, 0)
        false = dict.fromkeys(needed - task.init, 0)
        for i in self._team.deadline.each(actions):
            after, ground = self.before(i) + self._price(i), task.actions[i]
            for facts, known in ((ground.add, true), (ground.delete, false)):
                for f in facts:
                    if after < self._far and f in needed:
                        known[f] = min(after, known.get(f, self._far))
        return true, false

    def partners(self, action: int, but: int) -> int:
        """What was spent before all who take part in an action, without one, are where it starts."""
        least = 0
        for k in self._team.task.actions[action].participants:
            if k in self.states and k != but:
                least = max(least, self._at.get((action, k), self._far))
        return least

    def arc(self, agent: int, state: int, action: int) -> int:
        """What was spent once an agent has done an action from a state."""
        if action not in self.ready:
            return self._far
        return max(self.states[agent][state], self.ready[action]) + self._price(action)

    def _run(self) -> None:
        for k, states in self.states.items():
            states[0] = 0
            heappush(self._events, (0, _STATE, k, 0))
        deadline = self._team.deadline
        while self._events:
            deadline.tick()
            value, kind, k, what = heappop(self._events)
            if kind == _STATE:
                if value == self.states[k][what]:
                    self._leave(value, k, self._team.moves[k][what])
            else:
                known = self._true if kind == _TRUE else self._false
                if what not in known:
                    known[what] = value
                    for action in self._waiting[kind - 1].pop(what, ()):
                        self._less(value, action)

    def _leave(self, value: int, k: int, moves: list[Move]) -> None:
        for action, target in moves:
            if (action, k) not in self._at:
                self._at[action, k] = value
                if action not in self._missing:
                    self._meet(action)
                self._less(value, action)
            if action in self.ready:
                self._push(value, action, k, target)
            else:
                self._blocked.setdefault(action, []).append((k, target))

    def _meet(self, action: int) -> None:
        """Count what an action needs, when it is met for the first time."""
        team, missing = self._team, 0
        for k in team.task.actions[action].participants:
            missing += k in self.states or action not in self._offered
        for f in team.pre[action]:
            if f not in self._free_true and f not in self._true:
                missing += 1
                self._waiting[0].setdefault(f, []).append(action)
        for f in team.neg[action]:
            if f in team.task.init and f not in self._free_false and f not in self._false:
                missing += 1
                self._waiting[1].setdefault(f, []).append(action)
        self._missing[action] = missing

    def _less(self, value: int, action: int) -> None:
        """One of the things that an action needs is there."""
        self._missing[action] -= 1
        if self._missing[action]:
            return
        self.ready[action] = value
        after = value + self._price(action)
        for f in self._team.task.actions[action].add:
            if f in self._team.needed and f not in self._free_true and f not in self._true:
                heappush(self._events, (after, _TRUE, 0, f))
        for f in self._team.task.actions[action].delete:
            if f in self._team.needed and f not in self._free_false and f not in self._false:
                heappush(self._events, (after, _FALSE, 0, f))
        for k, target in self._blocked.pop(action, ()):
            self._push(value, action, k, target)

    def _push(self, value: int, action: int, k: int, target: int) -> None:
        total = value + self._price(action)
        if total < self.states[k][target]:
            self.states[k][target] = total
            heappush(self._events, (total, _STATE, k, target))
