"""Cases played by helpers, in the loop of :class:`serendipity.Execution`."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from serendipity.execution import Execution, Omniscient, Robots, moment_of
from serendipity_testing.league.cases import FREE, Case, Scenario
from serendipity_testing.league.protocol import AskedRobots, Helper

SETUP: Final = 10.0
"""Seconds before the first epoch."""

_IN_VAIN: Final = 2
"""Who never gets there pays as if they began anew so many times."""


@dataclass(frozen=True, slots=True)
class PersonPlayed:
    """What became of one person: what they paid (alone at least, if late), and when they were there."""

    scenario: Scenario
    paid: Fraction
    arrived: int | None
    epochs: int
    late: int
    faults: tuple[str, ...]


class Run:
    """A run: one person, who does as they are asked, and unasked as somebody observant (semantics 6).

    Where different goals are possible it goes on until nobody would be under way alone any more, since nobody
    tells robots whose goal is reached; else until the person is there; at most twice as long.

    Args:
        case: what is played.
        scenario: what is true; only the person knows.
        robots: who decide.
        seconds: for each decision, or None.
        setup: seconds before the first epoch, where there is a plan to be made then.

    Attributes:
        loop: as it stands.
    """

    def __init__(
        self, case: Case, scenario: Scenario, robots: Robots, seconds: float | None, setup: float = 0
    ) -> None:
        task = case.task.with_goal(scenario.goal)
        self._case, self._scenario, self._robots = case, scenario, robots
        plans, discount = case.library(), FREE["discount"]
        self.loop = Execution(
            task, discount=discount, plans=plans, told=True, deadline=seconds, setup=setup, robots=robots
        )
        self.loop.goal = scenario.name
        self._person = Omniscient(task, scenario.plan)

    @property
    def over(self) -> bool:
        """Whether there is nothing more to play."""
        run, horizon = self.loop, self._case.horizon
        there = run.done and (run.epoch > horizon or not self._case.torn)
        return there or run.epoch > 2 * horizon

    def step(self) -> None:
        """Play an epoch."""
        self.loop.step(self._person.choose(moment_of(self.loop)))

    def played(self) -> PersonPlayed:
        """What has become of it."""
        run, alone = self.loop, self._scenario.alone
        away = [passed.epoch for passed in run.passed if not passed.done]
        arrived = max(away, default=0) + 1 if run.done else None
        paid = run.human_cost
        if arrived is None:
            paid += _IN_VAIN * alone
        elif arrived > self._case.horizon:
            paid = max(paid, alone)
        verdicts = [passed.decided.verdict for passed in run.passed]
        faults = self._robots.faults if isinstance(self._robots, AskedRobots) else ()
        return PersonPlayed(
            self._scenario, paid, arrived, len(verdicts), verdicts.count("late"), tuple(faults)
        )


def played(
    case: Case, helper: Helper, deadline: float | None, setup: float = SETUP
) -> Iterator[PersonPlayed]:
    """A case, for each of its scenarios once: what it comes to in the mean is not left to chance."""
    for scenario in case.scenarios:
        seconds = helper.seconds or deadline
        run = Run(case, scenario, helper.robots(case, setup), seconds, setup if helper.plans else 0)
        while not run.over:
            run.step()
        yield run.played()
