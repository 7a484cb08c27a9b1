"""The human who replans where actions take time: they look up whenever they are free (semantics 10.6)."""

from collections.abc import Collection, Iterable

from search.call.prepared_task import PreparedTask
from search.human.individual_planner import FoundPlan, IndividualPlanner, Memory
from search.modes.simulation.human import Glance, Human, HumanStep, Intention
from search.packed.cost_vector import INFINITE_KEY
from search.packed.due import Due
from search.packed.joint_actions import NOTHING, JointAction
from search.packed.successor_generator import BesideScript
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline


class BesideOthers(IndividualPlanner):
    """The human alone, robots going on with what they are at, and beginning nothing.

    Args:
        later: the same once nobody else is at anything, and nothing happens any more.
    """

    def __init__(self, human: Human, later: IndividualPlanner, due: Due, options: Options) -> None:
        context = human.context
        memory = Memory(human.packed, strict=options.strict)
        memory.lookup = BesideScript(human.packed, memory.weight, strict=options.strict)
        bound = context.tables.human.projection(context.deadline)
        super().__init__(human.packed, human.packed.goal, bound, memory, context.deadline, context.weights)
        self.mask = human.packed.all_ones
        self._later, self._due = later, due

    def canonical(self, state: int) -> FoundPlan | None:
        """See :class:`.IndividualPlanner`."""
        return self._later.canonical(state) if self._due.is_calm(state) else super().canonical(state)

    def _least_from(self, state: int, limit: int = INFINITE_KEY) -> int:
        if self._due.is_calm(state):
            return self._later._least_from(state & self._later.mask, limit)
        return super()._least_from(state, limit)

    def _rest(self, state: int) -> int | None:
        if self._due.is_calm(state):
            return self._later._least_from(state & self._later.mask)
        return super()._rest(state)

    def _take_over(self) -> None:
        """The kernel knows nothing of what goes on."""


class HumanInTime(Human):
    """One human in a task of single epochs.

    Args:
        options: discount, weights, the human model, and the head start, in which they are not up.
    """

    def __init__(
        self, prepared: PreparedTask, options: Options, deadline: Deadline, actions: Collection[int] = ()
    ) -> None:
        super().__init__(prepared, options, deadline, human_model=options.human_model, actions=actions)
        self._due = Due(self.packed, self.weights.team, strict=options.strict)
        self.alone = BesideOthers(self, self.alone, self._due, options)
        self.concern = self.packed.all_ones
        waiting = map(self.packed.op, self.packed.idling[:1] if self.packed.prices_waiting else ())
        self._epoch_of_waiting = sum(map(self.weights.team, waiting))

    def unasked(
        self, state: int, epoch: int, belief: int, intention: Intention
    ) -> Iterable[HumanStep] | None:
        """See :class:`.Human`: they are at something, or not up yet."""
        going_on = self._due.human(state)
        if going_on is None and epoch >= self.asleep:
            return None
        if going_on is None:
            return [HumanStep(NOTHING, self.expects(belief, NOTHING), intention.rest, False)]
        found = []
        for part in going_on:
            own = intention.op is not None and intention.op.action == part.actions[0]
            rest = intention.rest if own else intention
            found.append(HumanStep(part, self.expects(belief, part), rest, False))
        return found

    def expects(self, belief: int, own: JointAction) -> int:
        """See :class:`.Human`; others go on as the human takes them to, and the script does."""
        return belief if self.sees_all else self._due.supposed(belief, own)

    def follows(self, state: int, part: JointAction) -> int | None:
        """See :class:`.Human`; others go on meanwhile, and the script does."""
        return self._due.after(state, (part,))

    def goes_on(self, belief: int, state: int, look: Glance) -> HumanStep:
        """See :class:`.Human`; what robots begin may always be news, so nothing is settled.

        Whether waiting is paid for is only known when they begin something.
        """
        own = None if look.best is None else look.intention.op
        if own is not None and own.action in self.packed.idling:
            return HumanStep(NOTHING, self.expects(belief, NOTHING), look.intention.rest, False)
        return super().goes_on(belief, state, look)._replace(settled=False)

    def paid(self, part: JointAction, waited: int) -> tuple[JointAction, int]:
        """See :class:`.Human`."""
        if not part.actions:
            return part, waited + self._epoch_of_waiting
        if not self.packed.counted(part.actions[0]):
            return part, waited
        return part._replace(weight=part.weight + waited), 0
