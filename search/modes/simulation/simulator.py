"""Plays a composite plan against a human who replans, epoch by epoch (semantics 6)."""

from collections.abc import Iterable, Sequence
from fractions import Fraction

from search.call.prepared_task import PreparedTask
from search.engine.best_first import Incumbent, Node
from search.modes.simulation.human import Glance, Human, Start
from search.packed.operators import Operator, applicable, changed
from serendipity.model.answers.simulation import (
    CONFLICT,
    INAPPLICABLE,
    REFUSED,
    SimulatedEpoch,
    Simulation,
    Skipped,
)
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan, Task
from serendipity.model.task.visibility import Visible


def simulate(
    prepared: PreparedTask,
    options: Options,
    human_plan: HumanPlan,
    steps: Iterable[Step],
    *,
    human_model: str,
    horizon: int | None,
    visible: Visible | None = None,
    deadline: Deadline | None = None,
) -> Simulation:
    """The robots' part of a plan, played beside a human who replans.

    Args:
        options: discount and interference.
        human_plan: their plan at the beginning; empty where they have none.
        steps: the composite plan; what it wants the human to do alone is not looked at.
        human_model: ``observant`` or ``local``.
        horizon: ``T``, or None for any.
        visible: what a local human sees; None for the default.

    Raises:
        LimitReachedError: the deadline ran out in the first epoch, or before it.
    """
    task, deadline, steps = prepared.task, deadline or Deadline(), tuple(steps)
    planned = (step.action for step in steps if not _is_own(task, step))
    asked = {*human_plan, *(v for i in planned for v in variants(task, i))}
    human = Human(prepared, options, deadline, human_model=human_model, actions=asked, visible=visible)
    return Run(human.start(human_plan), human, steps).play(horizon)


def way_on(start: Start, human: Human, steps: Sequence[Step], *, guarded: bool = False) -> Incumbent | None:
    """A plan that was made for another moment, played as before; None where it misses the goals.

    Args:
        guarded: whether it is none, either, where it leaves the human without a plan on the way.
    """
    if not steps or not all(human.packed.is_useful(step.action) for step in steps):
        return None
    played = Run(start, human, steps).play(None)
    if not played.goals_hold or any(epoch.skipped for epoch in played.epochs):
        return None
    node = Node(0, 0, start.state, 0, 0, None, ())
    for epoch in played.epochs:
        if guarded and human.stuck(node.state):
            return None
        node = human.context.after(node, [human.packed.op(i) for i in epoch.executed])
    return Incumbent(node.key, node)


def _is_own(task: Task, step: Step) -> bool:
    """Whether the human does a step alone."""
    return task.actions[step.action].participants == (task.human,)


def variants(task: Task, action: int) -> tuple[int, ...]:
    """The ids of the ground actions that are the same action to people: it comes first."""
    same = task.actions[action]
    others = task.named[same.name]
    return (action, *(i for i in others if i != action and task.actions[i].participants == same.participants))


class Run:
    """One simulation, from any moment on; every action of ``steps`` is packed."""

    def __init__(self, start: Start, human: Human, steps: Iterable[Step]) -> None:
        self.human = human
        self.packed = human.packed
        self.task = human.packed.task
        self.planned: dict[int, list[int]] = {}  # what robots take part in, by epoch
        for step in steps:
            if not _is_own(self.task, step):
                self.planned.setdefault(step.epoch, []).append(step.action)
        self.settled = False
        self.state, self.expected, self.intention = start

    def play(self, horizon: int | None) -> Simulation:
        """What happens in so many epochs, or until the end; see :func:`simulate`."""
        last = max(self.planned, default=0)
        epochs: list[SimulatedEpoch] = []
        limit = None
        while not self._done() and (horizon is None or len(epochs) < horizon):
            before = self.expected
            try:
                self.human.context.deadline.check()
                epoch = self._epoch(len(epochs) + 1)
            except LIMITS as error:
                if not epochs:
                    raise
                limit = limit_reason(error)
                break
            epochs.append(epoch)
            if epoch.epoch >= last and not epoch.executed and self.expected == before:
                break  # nothing will ever change again
        done = (self.packed.op(i) for epoch in epochs for i in epoch.executed)
        cost = self.human.keys.cost(sum(map(self.human.weights.team, done)))
        return Simulation(tuple(epochs), self._done(), cost, limit)

    def _epoch(self, number: int) -> SimulatedEpoch:
        human = self.human
        belief, look = human.look(self.expected, self.state, self.intention, settled=self.settled)
        saw = self._differences(self.expected, belief)
        offered = [self._variant(i) for i in sorted(self.planned.get(number, ()))]
        joint, skipped = self._joint(offered, belief, look)
        own = look.intention.op if joint is None and look.best is not None else None
        step = human.goes_on(belief, self.state, look) if joint is None else human.joins(joint, belief, look)
        robots = self._robots(offered, step.option.actions, skipped)
        self.expected, self.intention, self.settled = step.belief, step.intention, step.settled
        self.state = changed(self.state, map(self.packed.op, (*robots, *step.option.actions)))
        return SimulatedEpoch(
            number,
            saw,
            self._exact(look.kept),
            self._exact(look.best),
            look.replanned,
            look.intention.actions,
            None if joint is None else joint.action,
            None if own is None else own.action,
            own is not None and not step.settled,
            tuple(robots),
            tuple(skipped),
        )

    def _joint(
        self, offered: Sequence[int], belief: int, look: Glance
    ) -> tuple[Operator | None, list[Skipped]]:
        """The joint action with the human that takes place, and those that do not."""
        taken: Operator | None = None
        skipped = []
        for i in offered:
            op = self.packed.op(i)
            if not op.agents & self.packed.human_bit:
                continue
            if not applicable(op, self.state):
                skipped.append(Skipped(i, INAPPLICABLE))
            elif taken is not None:
                skipped.append(Skipped(i, CONFLICT))
            elif self.human.accepts(op, belief, look.best):
                taken = op
            else:
                skipped.append(Skipped(i, REFUSED))
        return taken, skipped

    def _robots(self, offered: Sequence[int], his: tuple[int, ...], skipped: list[Skipped]) -> list[int]:
        """What robots do without the human; the human has priority, and among robots the smaller id."""
        done, strict = list[int](), self.human.context.options.strict
        for i in offered:
            op = self.packed.op(i)
            if op.agents & self.packed.human_bit:
                continue
            if not applicable(op, self.state):
                skipped.append(Skipped(i, INAPPLICABLE))
            elif not all(self.packed.compatible(i, j, strict) for j in (*his, *done)):
                skipped.append(Skipped(i, CONFLICT))
            else:
                done.append(i)
        return done

    def _variant(self, action: int) -> int:
        """One that is applicable among ground actions with one name and the same agents."""
        possible = variants(self.task, action)
        return next((i for i in possible if applicable(self.packed.op(i), self.state)), action)

    def _done(self) -> bool:
        return self.packed.goal.holds(self.state) and self.packed.robot_goal.holds(self.state)

    def _differences(self, expected: int, found: int) -> tuple[tuple[int, bool], ...]:
        different = (expected ^ found) & self.human.concern
        if not different:
            return ()
        return tuple(
            (fact, found & bits[0] == bits[1])
            for fact, bits in enumerate(self.packed.fact_bits)
            if bits is not None
            and bits[0] & different
            and (expected & bits[0] == bits[1]) != (found & bits[0] == bits[1])
        )

    def _exact(self, scaled: int | None) -> Fraction | None:
        return None if scaled is None else Fraction(scaled, self.human.keys.scale)
