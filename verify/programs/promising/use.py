"""How much may be spent, at most, once robots have done something of which anybody makes use.

The other way round from :mod:`.spending`: from the human's actions, each with what robots may have
spent when it takes place, back along robots' paths and the facts that they change.  A robot's move after
which nothing that it did is of use to anybody is on no plan that is worth looking at: without it the
others can do the same.  With prices of 1 and epochs instead of costs it is the latest epoch.
"""

from collections.abc import Callable, Mapping
from heapq import heappop, heappush

from verify.programs.agents.product import Move
from verify.programs.promising.team import Team

_STATE, _TRUE, _FALSE, _ACTION = 0, 1, 2, 3

NEVER = -1


class Use:
    """The bounds for robots.

    Args:
        team: automata and needs.
        price: what an action takes of what may be spent.
        true: for facts that the human needs true, what may have been spent when they become so.
        false: the same for facts that they need false.
        joint: for the human's joint actions, what may have been spent afterwards.
        end: what may have been spent at the end, for goals and robots who go on to it.
    """

    def __init__(
        self,
        team: Team,
        price: Callable[[int], int],
        true: Mapping[int, int],
        false: Mapping[int, int],
        joint: Mapping[int, int],
        end: int,
    ) -> None:
        self._team = team
        self._price = price
        self._end = end
        self._events: list[tuple[int, int, int, int]] = []
        self._states = {k: [NEVER] * len(team.moves[k]) for k in team.robots}
        self._backward: dict[int, list[list[Move]]] = {k: team.backward(k) for k in team.robots}
        self._actions: dict[int, int] = {}
        self._known: tuple[set[int], set[int]] = set(), set()
        self._offered: dict[int, dict[int, int]] = {_TRUE: {}, _FALSE: {}, _ACTION: {}}
        self._sources: dict[int, list[tuple[int, int]]] = {}
        self._makers: tuple[dict[int, list[int]], dict[int, list[int]]] = {}, {}
        self._index()
        for f, value in (*true.items(), *((f, end) for f in team.wanted_true)):
            self._offer(value, _TRUE, f)
        for f, value in (*false.items(), *((f, end) for f in team.wanted_false)):
            self._offer(value, _FALSE, f)
        for action, value in joint.items():
            if action in self._sources:
                self._offer(value, _ACTION, action)
        self._run()

    def arc(self, agent: int, action: int, target: int) -> int:
        """What may have been spent once an agent has done an action; :data:`NEVER`: it is of no use."""
        if agent in self._team.watched:
            return self._end
        return max(self._actions.get(action, NEVER), self._states[agent][target])

    def state(self, agent: int, state: int) -> int:
        """What may have been spent when an agent is in a state and goes on; :data:`NEVER`: it needn't."""
        return self._end if agent in self._team.watched else self._states[agent][state]

    def _index(self) -> None:
        for k in self._team.robots:
            for moves in self._team.deadline.each(self._backward[k]):
                for action, source in moves:
                    if action not in self._sources:
                        self._sources[action] = []
                        ground = self._team.task.actions[action]
                        for facts, makers in zip((ground.add, ground.delete), self._makers, strict=True):
                            for f in facts:
                                makers.setdefault(f, []).append(action)
                    if k in self._team.watched:
                        self._offer(self._end, _ACTION, action)
                    self._sources[action].append((k, source))

    def _offer(self, value: int, kind: int, what: int) -> None:
        if value > self._offered[kind].get(what, NEVER):
            self._offered[kind][what] = value
            heappush(self._events, (-value, kind, 0, what))

    def _run(self) -> None:
        while self._events:
            self._team.deadline.tick()
            negative, kind, k, what = heappop(self._events)
            value = -negative
            if kind == _STATE:
                if value == self._states[k][what]:
                    for action, source in self._backward[k][what]:
                        self._before(value, action, k, source)
            elif kind == _ACTION:
                if what not in self._actions:
                    self._actions[what] = value
                    for k, source in self._sources[what]:
                        self._before(value, what, k, source)
            elif what not in self._known[kind - 1]:
                self._known[kind - 1].add(what)
                for action in self._makers[kind - 1].get(what, ()):
                    self._offer(value, _ACTION, action)

    def _before(self, value: int, action: int, k: int, source: int) -> None:
        """An agent's move is of use: so is what it needs."""
        left = value - self._price(action)
        if left > self._states[k][source]:
            self._states[k][source] = left
            heappush(self._events, (-left, _STATE, k, source))
        for f in self._team.pre[action]:
            self._offer(left, _TRUE, f)
        for f in self._team.neg[action]:
            self._offer(left, _FALSE, f)
        if len(self._team.task.actions[action].participants) > 1:
            self._offer(value, _ACTION, action)
