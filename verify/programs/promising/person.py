"""The human's paths in their automaton, where robots have to spend something for some of the actions.

A plan in which the dearest of what robots provide for has made them spend ``s`` is a path over actions that
ask nothing dearer of them, and costs that path and ``s``, at least.  So paths are looked at level by level:
each has a limit on what may be asked of robots, and adds the least that a path asks for which is on no lower
level.  What robots can't provide for on a level the human has to have made on the same path.

Where windows are short there are such levels of epochs, too: if the last of what robots provide for takes
them ``t`` epochs, the window is open in epoch ``t`` or later, and until it opens the human does what is
planned.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from itertools import pairwise
from typing import Final

from verify.programs.agents.product import Move
from verify.programs.promising.spending import Spending
from verify.programs.promising.team import Team

_LEVELS: Final = 10

Literal = tuple[int, bool]
"""A fact, and whether it has to be true."""

_NO_FACT: Final[Literal] = (-1, False)


@dataclass(frozen=True, slots=True)
class Asked:
    """What the human's actions ask of robots: what these have spent by then at least, or how many epochs.

    Attributes:
        needs: for each action, if all that the human could make were there.
        partners: for each action, before those who take part in it are there.
        true: for facts that robots can make true; 0 for what is true.
        false: for facts that robots can make false; 0 for what is false.
        by_epoch: whether it is epochs: an action with partners is done in the next one.
    """

    needs: Mapping[int, int]
    partners: Mapping[int, int]
    true: Mapping[int, int]
    false: Mapping[int, int]
    by_epoch: bool

    @classmethod
    def of(cls, team: Team, spent: Spending, offered: set[int], *, by_epoch: bool = False) -> "Asked":
        """From what was spent where all that the ``offered`` actions of the human's make is free."""
        actions, human = team.task.actions, team.task.human
        needs, partners = {}, {}
        for i in team.deadline.each(offered):
            partners[i] = spent.partners(i, human) + (by_epoch and len(actions[i].participants) > 1)
            needs[i] = max(spent.facts(i), partners[i])
        robots = (i for i in spent.ready if human not in actions[i].participants)
        return cls(needs, partners, *spent.made(robots), by_epoch)

    def literals(self, team: Team, action: int) -> Iterator[tuple[Literal, int]]:
        """The facts that an action needs true, and false, and what they ask for."""
        for f in team.pre[action]:
            yield (f, True), self.true.get(f, team.far)
        for f in team.neg[action]:
            yield (f, False), self.false.get(f, team.far)

    def each(self, team: Team) -> Iterator[tuple[int, Literal | int]]:
        """All that is asked for, and of which action or fact."""
        for i in team.deadline.each(self.partners):
            yield self.partners[i], i
            for literal, value in self.literals(team, i):
                yield value, literal

    def value(self, team: Team, what: Literal | int) -> int:
        """What is asked for of an action or fact."""
        if isinstance(what, int):
            return self.partners[what]
        f, holds = what
        return (self.true if holds else self.false).get(f, team.far)


@dataclass(slots=True)
class Level:
    """The paths that ask for no more than some amount, or some number of epochs.

    Attributes:
        least: what robots have spent at least.
        most: what may be asked for.
        before: how many of the human's actions are planned, at least.
        done: for each state the least price of a way there, as planned at first; a missing one is not within
            the limit.
        left: the least price of a way from there to the goal.
        ready: what is paid before the facts are there that an action needs and the human has to make;
            a missing one needs none.
        total: the least price of a whole path.
    """

    least: int
    most: int
    before: int
    done: Mapping[int, int]
    left: Mapping[int, int]
    ready: Mapping[int, int]
    total: int


def levels(team: Team, asked: Asked, spent: Asked) -> list[Level]:
    """The levels on which there are paths that are cheap enough.

    Args:
        team: automata, prices, and what may be spent in all.
        asked: what there are levels of.
        spent: what robots have spent, which is the same where levels are not of epochs.
    """
    highest = team.horizon if asked.by_epoch else team.most
    values = sorted({value for value, _ in asked.each(team) if value <= highest} | {0})
    backward = team.backward(team.task.human)
    found = []
    for low, high in pairwise(cuts(values)):
        if low >= high:
            continue
        least, most, before = values[low], values[high - 1], 0
        opened: Mapping[int, int] = {0: 0}
        if asked.by_epoch and team.windows is not None:
            before, opened = team.windows.open(least)
            if least:
                least = min(
                    spent.value(team, what) for value, what in asked.each(team) if least <= value <= most
                )
        level = _level(team, backward, asked, (least, most), before, opened)
        if level is not None:
            found.append(level)
    return found


def cuts(values: Sequence[int]) -> list[int]:
    """Where to divide ascending values into levels, as positions; the first level is without any help."""
    count = min(_LEVELS, len(values))
    found = [len(values) * k // count for k in range(count)] + [len(values)]
    if values[0] == 0 and len(values) > 1 and count > 1:
        found[1] = 1
    return found


def _level(
    team: Team,
    backward: list[list[Move]],
    asked: Asked,
    limits: tuple[int, int],
    before: int,
    opened: Mapping[int, int],
) -> Level | None:
    human, (least, most) = team.task.human, limits
    limit, finals = team.most - least, team.finals[human]
    left = _distances(team, backward, dict.fromkeys(finals, 0), asked.needs, most, limit)
    if min((paid + left.get(state, team.far) for state, paid in opened.items()), default=team.far) > limit:
        return None
    planned = {} if team.windows is None else team.windows.planned
    earlier = {i for (_, i), position in planned.items() if position < before}
    ways = _Ways(team, asked, most, earlier, opened, left, limit)
    total = min((ways.done.get(state, team.far) for state in finals), default=team.far)
    return None if total > limit else Level(least, most, before, ways.done, left, ways.ready, total)


class _Ways:
    """The human's ways on a level, where what an action needs may have to be made by themselves first."""

    def __init__(
        self,
        team: Team,
        asked: Asked,
        most: int,
        earlier: set[int],
        opened: Mapping[int, int],
        left: Mapping[int, int],
        limit: int,
    ) -> None:
        self._team, self._left, self._limit, self._far = team, left, limit, team.far
        self.done, self.ready = dict(opened), dict[int, int]()
        self._made: dict[Literal, int] = {(f, True): 0 for i in earlier for f in team.task.actions[i].add}
        self._made |= {(f, False): 0 for i in earlier for f in team.task.actions[i].delete}
        self._missing: dict[int, int] = {}
        self._waiting: dict[Literal, list[int]] = {}
        for i in team.deadline.each(asked.needs):
            lacking = [
                what for what, value in asked.literals(team, i) if value > most and what not in self._made
            ]
            for what in lacking:
                self._waiting.setdefault(what, []).append(i)
            if lacking:
                self._missing[i], self.ready[i] = len(lacking), team.far
        self._possible = {i for i, value in asked.needs.items() if value <= most}
        self._blocked: dict[int, list[int]] = {}
        self._queue: list[tuple[int, int, Literal]] = [
            (paid, state, _NO_FACT) for state, paid in opened.items()
        ]
        heapify(self._queue)
        self._run()

    def _run(self) -> None:
        while self._queue:
            self._team.deadline.tick()
            value, state, literal = heappop(self._queue)
            if state >= 0:
                if value == self.done[state]:
                    self._leave(value, state)
            elif value == self._made[literal]:
                for action in self._waiting.pop(literal, ()):
                    self._missing[action] -= 1
                    if not self._missing[action]:
                        self.ready[action] = value
                        for target in self._blocked.pop(action, ()):
                            self._go(value, action, target)

    def _leave(self, value: int, state: int) -> None:
        for action, target in self._team.moves[self._team.task.human][state]:
            if action in self._possible:
                if self.ready.get(action, 0) < self._far:
                    self._go(value, action, target)
                else:
                    self._blocked.setdefault(action, []).append(target)

    def _go(self, value: int, action: int, target: int) -> None:
        total, far = value + self._team.price[action], self._far
        if total + self._left.get(target, far) > self._limit:
            return
        if total < self.done.get(target, far):
            self.done[target] = total
            heappush(self._queue, (total, target, _NO_FACT))
        ground = self._team.task.actions[action]
        for facts, holds in ((ground.add, True), (ground.delete, False)):
            for f in facts:
                literal = f, holds
                if literal in self._waiting and total < self._made.get(literal, far):
                    self._made[literal] = total
                    heappush(self._queue, (total, -1, literal))


def _distances(
    team: Team,
    edges: list[list[Move]],
    sources: Mapping[int, int],
    needs: Mapping[int, int],
    most: int,
    limit: int,
) -> dict[int, int]:
    """Least prices of ways over actions whose needs cost at most ``most``, within a limit."""
    price, best, far = team.price, dict(sources), team.far
    queue = [(0, state) for state in best]
    while queue:
        team.deadline.tick()
        distance, state = heappop(queue)
        if distance > best[state]:
            continue
        for action, target in edges[state]:
            if needs.get(action, far) > most:
                continue
            total = distance + price[action]
            if total <= limit and total < best.get(target, far):
                best[target] = total
                heappush(queue, (total, target))
    return best


def fewest(team: Team) -> list[int]:
    """For each state of the human's the fewest actions to the end; ``far``: there is no way."""
    backward = team.backward(team.task.human)
    found = [team.far] * len(backward)
    layer = list(team.finals[team.task.human])
    for state in layer:
        found[state] = 0
    steps = 0
    while layer and steps < team.far:
        steps += 1
        following = []
        for state in team.deadline.each(layer):
            for _, source in backward[state]:
                if found[source] == team.far:
                    found[source] = steps
                    following.append(source)
        layer = following
    return found
