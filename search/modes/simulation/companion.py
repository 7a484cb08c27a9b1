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
from search.engine.paths import path_steps, plan_steps
from search.modes.simulation.human import Human, Start
from search.modes.simulation.simulator import Simulation, simulate_from, way_on
from search.modes.simulation.space import Reactive
from search.packed.cost_vector import INFINITE_KEY
from search.packed.successor_generator import Successors
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
    """Robots beside one human with one goal, who may stand anywhere.

    Attributes:
        human: the human.
    """

    def __init__(
        self, prepared: PreparedTask, options: Options, deadline: Deadline, actions: Collection[int] = ()
    ) -> None:
        self._clock = Deadline()
        self._clock.renew(deadline)
        self._options = options
        model = options.human_model
        self.human = Human(prepared, options, self._clock, human_model=model, actions=actions)
        self._idle = self.human.context.successors(idle=True)
        self._successors: dict[frozenset[int], Successors] = {}

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
            start: where everybody is.
            barred: ids of actions that nobody may do, in one search after the other; only the last one
                proves that there is nothing better.
            deadline: of all of them.
            begins: what may happen in the first epoch.
            known: a way that was found before, which may still be good for something.
            keeps: whether robots don't make a plan impossible that the human would go on with.

        Raises:
            LimitReachedError: the deadline came before it was known what the human does alone, and, where
                they have no plan, before there was any with robots.
        """
        self._clock.renew(deadline)
        horizon = len(start.intention.actions) or MAX_EPOCH
        idle = self._search(start, Incumbent(INFINITE_KEY), horizon, self._idle)
        best = replace(idle)
        replayed = self._replayed(start, known, begins)
        if replayed is not None and replayed[0] < best.key:
            best = Incumbent(replayed[0])
        steps = None if replayed is None else replayed[1]
        proved = False
        for number, out in enumerate(barred):
            self._clock.renew(deadline.part(1 / (len(barred) - number)))
            try:
                self._search(start, best, horizon, self._without(out), begins, keeps=keeps)
                proved = number == len(barred) - 1
            except LIMITS:
                pass
        self._clock.renew(deadline)
        if best.key >= INFINITE_KEY:
            if not proved:
                raise LimitReachedError("time-limit")
            return None
        if best.node is not None:
            steps = tuple(sorted(path_steps(best.node) + plan_steps(best.tail, best.end)))
        keys = self.human.keys
        alone = None if idle.key >= INFINITE_KEY else keys.cost(idle.key)
        return Course(steps or (), keys.cost(best.key), alone, proved)

    def played(self, start: Start, steps: Sequence[Step], deadline: Deadline) -> Simulation:
        """What becomes of the robots' part of a plan; see :func:`.simulate`."""
        self._clock.renew(deadline)
        return simulate_from(start, self.human, self._options, steps, horizon=None, deadline=deadline)

    def _search(
        self,
        start: Start,
        best: Incumbent,
        horizon: int,
        successors: Successors,
        begins: Begins | None = None,
        *,
        keeps: bool = True,
    ) -> Incumbent:
        space = Reactive(
            self.human,
            successors,
            start=start,
            horizon=horizon,
            no_block=True,
            most_cost=None,
            keeps=keeps,
            begins=begins,
        )
        return solve_space(space, best, self._clock)

    def _replayed(
        self, start: Start, known: Sequence[Step], begins: Begins | None
    ) -> tuple[int, tuple[Step, ...]] | None:
        """The key and the steps of a known way from here; None where it does not lead to the goal."""
        first = tuple(step.action for step in known if step.epoch == 1)
        if begins is not None and not begins(first):
            return None
        played = way_on(start, self.human, self._options, known, self._clock)
        if played is None:
            return None
        packed, weights = self.human.packed, self.human.weights
        return sum(weights.team(packed.op(step.action)) for step in played.steps), played.steps

    def _without(self, barred: frozenset[int]) -> Successors:
        found = self._successors.get(barred)
        if found is None:
            found = self._successors[barred] = self.human.context.successors(barred=barred)
        return found
