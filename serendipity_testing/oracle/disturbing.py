"""How much an epoch disturbs the human, by brute force (semantics 13)."""

from collections.abc import Iterable
from math import lcm

from serendipity.model import Options
from serendipity.model.task.disturbance import disturbance_from
from serendipity.model.task.visibility import surroundings
from serendipity_testing.oracle.moments import Moment, OracleWorld


class Disturbing:
    """Counts what disturbs the human.

    Args:
        world: of the task.
        options: with the weights.

    Attributes:
        scale: amounts are counted in that part of 1.
    """

    def __init__(self, world: OracleWorld, options: Options) -> None:
        self._world, self._task = world, world.task
        kinds = disturbance_from(options.disturbance)
        self.scale = lcm(*(weight.denominator for weight in (kinds.ask, kinds.meet, kinds.sight)))
        weights = (kinds.ask, kinds.meet, kinds.sight)
        self._ask, self._meet, self._sight = (int(weight * self.scale) for weight in weights)
        self._seen = surroundings(world.task)

    def by(self, moment: Moment, begun: Iterable[int]) -> int:
        """What an epoch counts in which some actions begin."""
        task, found = self._task, 0
        human, located = task.agents[task.human], self._seen.located
        here = {place for fact, (who, place) in located.items() if who == human and fact in moment.state}
        robots = {task.agents[robot] for robot in task.robots}
        for action, part in (*((i, 0) for i in begun), *moment.going):
            if action >= len(task.actions):
                continue
            doers = {task.agents[agent] for agent in task.actions[action].participants}
            if human in doers:
                found += self._ask if len(doers) > 1 and part == 0 else 0
            elif doers <= robots:
                done = self._world.parts(action)[part]
                changed = {word for fact in (*done.add, *done.delete) for word in self._seen.parts[fact]}
                named = (*done.pre, *done.add) if part == 0 else done.add
                there = {located[fact][1] for fact in named if fact in located and located[fact][0] in doers}
                found += self._sight * bool(here & changed) + self._meet * bool(here & there)
        return found
