"""Rounds of bounds on the moves of all agents' automata, until none of them drops anything.

A move stays if all of this holds, each of which a plan within the limits satisfies:

* of the human: a path over it is cheap enough together with what robots must have spent for its needs, and
  after the earliest epoch in which it can take place there are enough for the rest; what is done together
  with others can take place while a window may still be open;
* of a robot: what must have been spent when it was done is no more than what may have been, for anybody to
  make use of it; and the same for epochs (:mod:`.bounds`).

A plan in which the dearest of what robots provide for has made them spend ``s`` is a path over actions that
ask nothing dearer of them, and costs that path and ``s``, at least.  So the human's paths are looked at level
by level: each has a limit on what may be asked of robots, and adds the least that a path asks for which is on
no lower level.  What robots can't provide for on a level the human has to have made on the same path.

Where windows are short there are such levels of epochs, too: if the last of what robots provide for takes
them ``t`` epochs, the window is open in epoch ``t`` or later, and until it opens the human does what is
planned.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from verify.limits import limits
from verify.packed.edges import distances
from verify.packed.layout import Ints
from verify.programs.agents.product import Move
from verify.programs.promising.arrays import Actions, Arcs, HumanWays, Mask, which
from verify.programs.promising.bounds import NEVER, Spending, Use
from verify.programs.promising.team import TeamMoves

_MOST_ROUNDS: Final = 6

_WORTH: Final = 0.9
"""A round that leaves more than this share of the moves is the last one."""

_LEVELS: Final = 10


def keep_promising(team: TeamMoves) -> bool:
    """Drop the moves that are on no plan within the limits; False if there is no plan.

    All moves stay where so few are not worth it.  Prices too large for machine words are divided, and rounded
    down: no sum gets larger than the limit so divided, so that no plan within the limits is lost.

    Args:
        team: its ``moves`` are replaced.
    """
    if team.count() < limits().many_moves:
        return True
    size, words = 4 * (team.far + max(team.price, default=0)), limits().weight
    divided = team if size <= words else team.divided(size // max(words, 1) + 1)
    if 4 * (divided.far + max(divided.price, default=0)) > words:
        return True
    moves = _Moves(divided)
    promising = _rounds(moves)
    team.moves = moves.lists()
    return promising


def _rounds(moves: "_Moves") -> bool:
    before = moves.count()
    for _ in range(_MOST_ROUNDS):
        if not moves.round():
            return False
        left = moves.count()
        if left > before * _WORTH:
            break
        before = left
    return True


def _cuts(values: Sequence[int]) -> list[int]:
    """Where to divide ascending values into levels, as positions; the first level is without any help."""
    count = min(_LEVELS, len(values))
    found = [len(values) * k // count for k in range(count)] + [len(values)]
    if values[0] == 0 and len(values) > 1 and count > 1:
        found[1] = 1
    return found


@dataclass(frozen=True, slots=True)
class _Judged:
    """What the human's actions ask of robots: what these have spent by then at least, or how many epochs.

    Attributes:
        needs: for each action, if all that the human could make were there.
        partners: for each action, before those who take part in it are there.
        made: for each literal that robots can bring about; 0 for what is so.
        by_epoch: whether it is epochs: an action with partners is done in the next one.
    """

    needs: Ints
    partners: Ints
    made: Ints
    by_epoch: bool = False

    def values(self, actions: Actions, offered: Mask, highest: int) -> list[int]:
        """What levels are made of."""
        asked = self.made[actions.needs.at(np.flatnonzero(offered))]
        values = np.unique(np.concatenate((self.partners[offered], asked)))
        return sorted({0, *values[values <= highest].tolist()})

    def least(self, actions: Actions, offered: Mask, spent: "_Judged", low: int, high: int) -> int:
        """What robots have spent at least if the last of what is needed of them is on a level."""
        taking = offered & (low <= self.partners) & (self.partners <= high)
        asked = actions.needs.at(np.flatnonzero(offered))
        asked = asked[(low <= self.made[asked]) & (self.made[asked] <= high)]
        return int(np.concatenate((spent.partners[taking], spent.made[asked])).min(initial=actions.far))


@dataclass(frozen=True, slots=True)
class _Level:
    """The human's paths that ask for no more than some amount, or some number of epochs.

    Attributes:
        least: what robots have spent at least.
        most: what may be asked for.
        before: how many of the human's actions are planned, at least.
        done: for each state the least price of a way there, as planned at first; ``far``: there is none.
        left: the least price of a way from there to the goal, likewise.
        ready: for each action what is paid before the facts are there that the human has to make for it.
        total: the least price of a whole path.
    """

    least: int
    most: int
    before: int
    done: Ints
    left: Ints
    ready: Ints
    total: int


class _Moves:
    """A team's moves, which get fewer."""

    def __init__(self, team: TeamMoves) -> None:
        self._team, self._human = team, team.task.human
        agents = len(team.machines)
        self._actions, self._arcs = Actions(team), Arcs.of(team)
        self._count = len(self._actions.price)
        self._everybody = np.ones(agents, bool)
        self._robots = which(team.robots, agents)
        self._watched = which(team.watched, agents)
        taking = self._actions.participants
        self._his = which(taking.keys()[taking.items == self._human], self._count)
        self._ones = np.ones(self._count, np.int64)
        self._by_robots = np.where(self._his, 0, self._actions.price)

    def count(self) -> int:
        """How many moves are left."""
        return len(self._arcs.source)

    def lists(self) -> list[list[list[Move]]]:
        """The moves that are left, by agent and state."""
        return [self._arcs.lists(k) for k in range(len(self._team.machines))]

    def round(self) -> bool:
        """Drop moves that are on no plan within the limits; False if there is no plan."""
        team, arcs, human = self._team, self._arcs, self._human
        deadline = team.deadline
        nobody = np.zeros(self._count, bool)
        epochs = Spending(self._actions, arcs, self._everybody, self._ones, nobody, deadline)
        offered = which(arcs.action[arcs.agent == human], self._count)
        spent = Spending(self._actions, arcs, self._robots, self._by_robots, offered, deadline)
        costs = self._judged(spent)
        both = [(costs, self._levels(costs, costs, offered))]
        if team.windows is not None:
            ones = np.where(self._his, 0, self._ones)
            earliest = Spending(self._actions, arcs, self._robots, ones, offered, deadline)
            times = self._judged(earliest, by_epoch=True)
            both.append((times, self._levels(times, costs, offered)))
        if not all(found for _, found in both):
            return False
        his = arcs.agent == human
        left = self._fewest(his)
        least = np.maximum.reduce([self._least(found, judged.needs) for judged, found in both])
        in_time = epochs.arcs() <= self._last(his, left)
        kept_by_him = his & in_time & (least < self._team.far)
        total = max(min(level.total for level in found) for _, found in both)
        kept_by_robots = self._useful(kept_by_him, least, total, spent.arcs(), epochs.arcs())
        self._arcs = arcs.only(kept_by_him | kept_by_robots)
        return True

    def _judged(self, spent: Spending, *, by_epoch: bool = False) -> _Judged:
        partners = spent.partners(self._human) + (self._actions.joint & by_epoch)
        return _Judged(np.maximum(spent.facts(), partners), partners, spent.made(~self._his), by_epoch)

    def _levels(self, judged: _Judged, spent: _Judged, offered: Mask) -> list[_Level]:
        """The levels on which there are paths that are cheap enough; what robots ``spent``, if by epoch."""
        team, found = self._team, []
        values = judged.values(self._actions, offered, team.horizon if judged.by_epoch else team.most)
        for low, high in pairwise(_cuts(values)):
            if low >= high:
                continue
            least, most, before = values[low], values[high - 1], 0
            opened: Mapping[int, int] = {0: 0}
            if judged.by_epoch and team.windows is not None:
                before, opened = team.windows.open(least)
                least = judged.least(self._actions, offered, spent, least, most) if least else 0
            level = self._level(judged, (least, most), before, opened)
            if level is not None:
                found.append(level)
        return found

    def _level(
        self, judged: _Judged, limits: tuple[int, int], before: int, opened: Mapping[int, int]
    ) -> _Level | None:
        team, arcs, (least, most) = self._team, self._arcs, limits
        there = (arcs.agent == self._human) & (judged.needs[arcs.action] <= most)
        source, action, target = arcs.source[there], arcs.action[there], arcs.target[there]
        weight, limit, goal = self._actions.price[action], team.most - least, self._ends()
        left = distances((target, source, weight), goal, team.far, team.deadline, limit)
        start = self._of_his(opened, self._team.far)
        if (start + left).min(initial=self._team.far) > limit:
            return None
        lacking = self._lacking(np.unique(action), judged.made > most, before)
        ways = HumanWays(
            (source, action, target, weight), lacking, self._actions, start, left, limit, team.deadline
        )
        total = int((ways.done + goal).min(initial=self._team.far))
        return None if total > limit else _Level(least, most, before, ways.done, left, ways.ready, total)

    def _lacking(self, asking: Ints, missing: Mask, before: int) -> tuple[Ints, Ints]:
        """What the human has to make for their actions, but for what planned ones have made: by action."""
        needs, planned = self._actions.needs, {} if self._team.windows is None else self._team.windows.planned
        done = [i for (_, i), earlier in planned.items() if earlier < before]
        missing[self._actions.changes.at(np.array(done, np.int64))] = False
        keys, facts = np.repeat(asking, np.diff(needs.start)[asking]), needs.at(asking)
        return keys[missing[facts]], facts[missing[facts]]

    def _of_his(self, values: Mapping[int, int], other: int) -> Ints:
        """Values of the human's states, and another one for all that have none."""
        first, found = self._arcs.first[self._human], np.full(self._arcs.states, other)
        states = np.fromiter(values, np.int64, len(values))
        within = (min(value, self._team.far) for value in values.values())
        found[first + states] = np.fromiter(within, np.int64, len(values))
        return found

    def _planned(self) -> Ints:
        """For each move how many of the human's are done before it, if it is planned; ``far`` if not."""
        arcs, found = self._arcs, np.full(len(self._arcs.source), self._team.far)
        planned = {} if self._team.windows is None else self._team.windows.planned
        first = int(arcs.first[self._human])
        known = {(first + state) * self._count + i: before for (state, i), before in planned.items()}
        keys = np.array(sorted(known), np.int64)
        if len(keys):
            values = np.array([known[key] for key in keys.tolist()], np.int64)
            mine = np.flatnonzero(arcs.agent == self._human)
            asked = arcs.source[mine] * self._count + arcs.action[mine]
            at = np.minimum(np.searchsorted(keys, asked), len(keys) - 1)
            same = keys[at] == asked
            found[mine[same]] = values[at[same]]
        return found

    def _ends(self) -> Ints:
        """0 for the human's states in which a plan may end, ``far`` for others."""
        return self._of_his(dict.fromkeys(self._team.finals[self._human], 0), self._team.far)

    def _fewest(self, mask: Mask) -> Ints:
        """For each state of the human's the fewest actions to the end, over some moves."""
        arcs = self._arcs
        source, target, team = arcs.source[mask], arcs.target[mask], self._team
        ones = np.ones(len(source), np.int64)
        return distances((target, source, ones), self._ends(), team.far, team.deadline)

    def _last(self, his: Mask, left: Ints) -> Ints:
        """For each of the human's moves the last epoch that leaves enough; in a window, if it is joint."""
        team, arcs = self._team, self._arcs
        last = team.horizon - left[arcs.target]
        if team.windows is not None:
            within = self._of_his(team.windows.last, 0)
            joint = his & self._actions.joint[arcs.action]
            last[joint] = np.minimum(last, within[arcs.source])[joint]
        return last

    def _least(self, found: list[_Level], needs: Ints) -> Ints:
        """For each of the human's moves the least price of a path over it, where it is cheap enough."""
        arcs, most = self._arcs, self._team.most
        best = np.full(len(arcs.source), self._team.far)
        planned = self._planned()
        for level in found:
            paid = np.maximum(level.done[arcs.source], level.ready[arcs.action])
            path = paid + self._actions.price[arcs.action] + level.left[arcs.target]
            path[planned < level.before] = level.total
            fits = (needs[arcs.action] <= level.most) & (path + level.least <= most)
            best = np.where(fits, np.minimum(best, path), best)
        return best

    def _useful(self, his: Mask, least: Ints, total: int, spent: Ints, epochs: Ints) -> Mask:
        """The robots' moves of which somebody makes use in time, beside those that the human keeps."""
        team, arcs = self._team, self._arcs
        budget, latest = np.full(self._count, NEVER), np.full(self._count, NEVER)
        action = arcs.action[his]
        np.maximum.at(budget, action, team.most - least[his])
        np.maximum.at(latest, action, self._last(his, self._fewest(his))[his])
        costs = self._use(self._by_robots, budget, 0, team.most - total)
        times = self._use(self._ones, latest, 1, team.horizon)
        return self._robots[arcs.agent] & (spent <= costs.arcs()) & (epochs <= times.arcs())

    def _use(self, price: Ints, human: Ints, before: int, end: int) -> Use:
        """Bounds from what may have been spent when the human's actions take place."""
        actions, team = self._actions, self._team
        done = np.flatnonzero(human > NEVER)
        literals = np.full(len(actions.initially), NEVER)
        sizes = np.diff(actions.needs.start)[done]
        np.maximum.at(literals, actions.needs.at(done), np.repeat(human[done] - before, sizes))
        for wanted, offset in ((team.wanted_true, 0), (team.wanted_false, actions.facts)):
            ends = np.array(sorted(wanted), np.int64) + offset
            literals[ends] = np.maximum(literals[ends], end)
        joint = np.where(actions.joint, human, NEVER)
        return Use(
            actions, self._arcs, self._robots, self._watched, price, literals, joint, end, team.deadline
        )
