"""The rounds of :mod:`.moves` on arrays, for teams with many moves: the same moves are left."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from verify.programs.promising.arrays import Actions, Arcs, Ints, distances, which
from verify.programs.promising.at_once import SpendingAtOnce, UseAtOnce
from verify.programs.promising.person import cuts
from verify.programs.promising.team import FAR, Team
from verify.programs.promising.use import NEVER


@dataclass(frozen=True, slots=True)
class _Level:
    """As :class:`.person.Level` has it; ``FAR`` where there is no way."""

    least: int
    most: int
    done: Ints
    left: Ints
    total: int


class ManyMoves:
    """A team's moves, which get fewer.

    Args:
        team: its ``moves`` are replaced by :meth:`write`.
    """

    def __init__(self, team: Team) -> None:
        self._team, self._human = team, team.task.human
        agents = len(team.machines)
        self._actions, self._arcs = Actions(team), Arcs.of(team)
        self._count = len(self._actions.price)
        self._everybody = np.ones(agents, bool)
        self._robots = which(team.robots, agents)
        self._watched = which(team.watched, agents)
        his = which(
            self._actions.participants.keys()[self._actions.participants.items == self._human], self._count
        )
        self._ones = np.ones(self._count, np.int64)
        self._by_robots = np.where(his, 0, self._actions.price)

    def count(self) -> int:
        """How many moves are left."""
        return len(self._arcs.source)

    def write(self) -> None:
        """Give the team the moves that are left."""
        self._team.moves = [self._arcs.lists(k) for k in range(len(self._team.machines))]

    def round(self) -> bool:
        """Drop moves that are on no plan within the limits; False if there is no plan."""
        team, arcs, human = self._team, self._arcs, self._human
        deadline = team.deadline
        nobody = np.zeros(self._count, bool)
        epochs = SpendingAtOnce(self._actions, arcs, self._everybody, self._ones, nobody, deadline)
        offered = nobody.copy()
        offered[arcs.action[arcs.agent == human]] = True
        spent = SpendingAtOnce(self._actions, arcs, self._robots, self._by_robots, offered, deadline)
        needs = np.maximum(spent.facts(), spent.partners(human))
        found = self._levels(needs, offered)
        if not found:
            return False
        his = arcs.agent == human
        left = self._fewest(his)
        least = self._least(found, needs)
        in_time = epochs.arcs() + left[arcs.target] <= team.horizon
        kept_by_him = his & in_time & (least < FAR)
        kept_by_robots = self._useful(kept_by_him, least, found, spent.arcs(), epochs.arcs())
        self._arcs = arcs.only(kept_by_him | kept_by_robots)
        return True

    def _levels(self, needs: Ints, offered: np.ndarray) -> list[_Level]:
        team, arcs = self._team, self._arcs
        his = arcs.agent == self._human
        source, action, target = arcs.source[his], arcs.action[his], arcs.target[his]
        asked, weight = needs[action], self._actions.price[action]
        goal = self._ends()
        start = np.full(arcs.states, FAR)
        start[arcs.first[self._human]] = 0
        values = np.unique(needs[offered & (needs <= team.most)]).tolist()
        values = values if values[:1] == [0] else [0, *values]
        found = []
        for low, high in pairwise(cuts(values)):
            if low >= high:
                continue
            least, most = values[low], values[high - 1]
            limit = team.most - least
            there = asked <= most
            ways = source[there], target[there], weight[there]
            back = ways[1], ways[0], ways[2]
            left = distances(back, goal, team.deadline, limit)
            total = int(left[arcs.first[self._human]])
            if total <= limit:
                done = distances(ways, start, team.deadline, limit, left)
                found.append(_Level(least, most, done, left, total))
        return found

    def _ends(self) -> Ints:
        """0 for the human's states in which a plan may end, ``FAR`` for others."""
        goal = np.full(self._arcs.states, FAR)
        goal[self._arcs.first[self._human] + np.array(sorted(self._team.finals[self._human]), np.int64)] = 0
        return goal

    def _fewest(self, mask: np.ndarray) -> Ints:
        """For each state of the human's the fewest actions to the end, over some moves."""
        arcs = self._arcs
        source, target = arcs.source[mask], arcs.target[mask]
        return distances((target, source, np.ones(len(source), np.int64)), self._ends(), self._team.deadline)

    def _least(self, found: list[_Level], needs: Ints) -> Ints:
        """For each of the human's moves the least price of a path over it, where it is cheap enough."""
        arcs, most = self._arcs, self._team.most
        best = np.full(len(arcs.source), FAR)
        for level in found:
            path = level.done[arcs.source] + self._actions.price[arcs.action] + level.left[arcs.target]
            fits = (needs[arcs.action] <= level.most) & (path + level.least <= most)
            best = np.where(fits, np.minimum(best, path), best)
        return best

    def _useful(
        self, his: np.ndarray, least: Ints, found: list[_Level], spent: Ints, epochs: Ints
    ) -> np.ndarray:
        """The robots' moves of which somebody makes use in time, beside those that the human keeps."""
        team, arcs = self._team, self._arcs
        budget, latest = np.full(self._count, NEVER), np.full(self._count, NEVER)
        action = arcs.action[his]
        np.maximum.at(budget, action, team.most - least[his])
        np.maximum.at(latest, action, team.horizon - self._fewest(his)[arcs.target[his]])
        cheapest = min(level.total for level in found)
        costs = self._use(self._by_robots, budget, 0, team.most - cheapest)
        times = self._use(self._ones, latest, 1, team.horizon)
        team.spare, team.latest = costs.state, times.state
        return self._robots[arcs.agent] & (spent <= costs.arcs()) & (epochs <= times.arcs())

    def _use(self, price: Ints, human: Ints, before: int, end: int) -> UseAtOnce:
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
        return UseAtOnce(
            actions, self._arcs, self._robots, self._watched, price, literals, joint, end, team.deadline
        )
