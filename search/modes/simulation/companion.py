"""The best help beside a human who replans, asked for again from epoch to epoch.

The tables, and what was found out about the human, are kept from one question to the next.  A question
is answered by what is known so far when its time is up: robots one by one first, which takes little
time, then all together.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from search.call.prepared_task import PreparedTask
from search.engine.best_first import Incumbent, solve_space
from search.engine.paths import whole_plan
from search.modes.simulation.human import Human, Start
from search.modes.simulation.simulator import Run, way_on
from search.modes.simulation.space import Reactive
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model.answers.simulation import Simulation
from serendipity.model.errors import LIMITS, LimitReachedError
from serendipity.model.options import MAX_EPOCH, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import Step

Begins = Callable[[tuple[int, ...]], bool]
"""Whether a set of actions may be what happens in the first epoch."""


@dataclass(frozen=True, slots=True)
class Course:
    """A way to go on, the human's part as it follows from the model.

    Attributes:
        steps: what everybody does, epochs counted from the start.
        cost: what that costs the team.
        alone: what it costs the human with robots idle; None where they don't get there.
        proved: whether nothing is cheaper.
    """

    steps: tuple[Step, ...]
    cost: Fraction
    alone: Fraction | None
    proved: bool

    @property
    def pays(self) -> bool:
        """Whether robots do something, and that is worth it."""
        return self.alone is None or self.cost < self.alone


class Companion:
    """Robots beside one human with one goal, who may stand anywhere."""

    def __init__(
        self, prepared: PreparedTask, options: Options, deadline: Deadline, actions: Collection[int] = ()
    ) -> None:
        self._clock = Deadline()
        self._clock.renew(deadline)
        model = options.human_model
        self.human = Human(prepared, options, self._clock, human_model=model, actions=actions)
        self._idle = self.human.context.successors(idle=True)

    def under(self, deadline: Deadline) -> Human:
        """The human, whose thinking polls a deadline from now on."""
        self._clock.renew(deadline)
        return self.human

    def course(
        self,
        start: Start,
        barred: Sequence[frozenset[int]],
        deadline: Deadline,
        *,
        begins: Begins | None = None,
        known: Sequence[Step] = (),
        keeps: bool = True,
    ) -> Course | None:
        """The best way to go on that is found in time; None where robots can't make the human get there.

        Args:
            barred: ids of actions that nobody may do, in one search after the other; only the last one
                proves that there is nothing better.
            known: a way that was found before, which may still be good for something.
            keeps: whether robots don't make a plan impossible that the human would go on with.

        Raises:
            LimitReachedError: the deadline came before it was known what the human does alone, and, where
                they have no plan, before there was any with robots.
        """
        self._clock.renew(deadline)
        horizon = len(start.intention.actions) or MAX_EPOCH
        space = Reactive(self.human, self._idle, start, horizon, keeps=True)
        idle = solve_space(space, Incumbent(INFINITE_KEY), self._clock)
        best = replace(idle)
        if begins is None or begins(tuple(step.action for step in known if step.epoch == 1)):
            replayed = way_on(start, self.human, known)
            if replayed is not None and replayed.key < best.key:
                best = replayed
        proved = False
        for number, out in enumerate(barred):
            self._clock.renew(deadline.part(1 / (len(barred) - number)))
            successors = self.human.context.successors(barred=out)
            space = Reactive(self.human, successors, start, horizon, keeps=keeps, begins=begins)
            try:
                solve_space(space, best, self._clock)
                proved = number == len(barred) - 1
            except LIMITS:
                pass
        self._clock.renew(deadline)
        if best.key >= INFINITE_KEY:
            if not proved:
                raise LimitReachedError("time-limit")
            return None
        keys = self.human.keys
        alone = None if idle.key >= INFINITE_KEY else keys.cost(idle.key)
        return Course(whole_plan(best), keys.cost(best.key), alone, proved)

    def played(self, start: Start, steps: Sequence[Step], deadline: Deadline) -> Simulation:
        """What becomes of the robots' part of a plan; see :func:`.simulate`."""
        return Run(start, self.under(deadline), steps).play(None)
