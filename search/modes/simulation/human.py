"""The human's state machine: what they decide when they look up (semantics 6, steps 1 and 2)."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask, TaskTables
from search.human.individual_planner import canonical
from search.modes.simulation.eyes import Eyes, as_told, nearby
from search.packed.cost_vector import INFINITE_KEY
from search.packed.joint_actions import NOTHING, JointAction, as_option
from search.packed.operators import Operator, applicable, asked_by, union
from search.packed.packed_task import PackedTask
from search.packed.packings import asked_facts
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import HumanPlan
from serendipity.model.task.visibility import Visible


@dataclass(eq=False)
class Intention:
    """The rest of the human's current plan (``rho`` of semantics 6), one object for each sequence of actions.

    Attributes:
        op: the first action, packed; None at the end.
        option: what it does; nothing at the end.
        weight: key increment of all its actions.
        cost: their cost, scaled.
        after: the intention after it; None at the end.
    """

    op: Operator | None = None
    option: JointAction = NOTHING
    weight: int = 0
    cost: int = 0
    after: "Intention | None" = None

    @property
    def rest(self) -> "Intention":
        """What remains after the first action."""
        return self.after or self

    @cached_property
    def actions(self) -> tuple[int, ...]:
        """Action ids, in order."""
        found: list[int] = []
        at = self
        while at.op is not None:
            found += at.option.actions
            at = at.rest
        return tuple(found)


class Glance(NamedTuple):
    """The human's decision after a look; costs are scaled, None is infinite.

    Attributes:
        intention: what they mean to do now.
        kept: ``c``, what their plan costs where it still works.
        best: ``h``, their optimal cost alone; where it is None they wait.
    """

    intention: Intention
    kept: int | None
    best: int | None

    @property
    def replanned(self) -> bool:
        """Whether the human has changed their mind."""
        return self.best is not None and self.kept != self.best


class Start(NamedTuple):
    """The state in which robots and the human begin, and what the human has in mind.

    Attributes:
        state: packed, as it truly is.
        belief: packed, what the human expects to see.
        intention: what they mean to do.
    """

    state: int
    belief: int
    intention: Intention


class HumanStep(NamedTuple):
    """The human's part of an epoch, and what it leaves them with.

    Attributes:
        option: what it does; nothing where they wait, or try what is impossible.
        belief: what they expect to see next.
        intention: what remains of their plan.
        settled: whether they did the first step of an optimal plan, whose rest stays optimal until something
            surprises them.
    """

    option: JointAction
    belief: int
    intention: Intention
    settled: bool


class Human:
    """One human with their beliefs, plans and decisions, in packed states.

    Args:
        options: discount and weights.
        human_model: ``observant`` or ``local``.
        actions: ids of actions that will be asked about, beyond the useful ones.
        visible: what a local human sees; None for the default.

    Attributes:
        context: the task as they see it.
        sees_all: whether they are observant, so that they believe what is true.
        asleep: epochs in which they are not up yet.
    """

    def __init__(
        self,
        prepared: PreparedTask,
        options: Options,
        deadline: Deadline,
        *,
        human_model: str,
        actions: Collection[int] = (),
        visible: Visible | None = None,
    ) -> None:
        local = human_model == "local"
        told = local and visible is not None
        tables = _packing(prepared, actions, deadline, local=local, told=told)
        self.context = SearchContext(prepared, options, deadline, tables=tables)
        self.packed = tables.packed
        self.weights = self.context.weights
        self.keys = self.weights.keys
        self.alone = self.context.alone
        self.sees_all = not local
        self.asleep = options.head_start
        if not local:
            self.eyes = Eyes(0, lambda _: -1)
        elif visible is None:
            self.eyes = nearby(self.packed, prepared.surroundings(deadline))
        else:
            self.eyes = as_told(self.packed, visible)
        task = prepared.task
        asked = (i for i in actions if task.actions[i].participants == (task.human,))
        self.concern = self.packed.own_mask | self.packed.goal.mask
        self.concern |= union(asked_by(self.packed.op(i)) for i in asked)
        self._end = Intention()
        self._intentions: dict[tuple[int, Intention], Intention] = {}  # by the first action, and what is left
        self._looks: dict[tuple[int, Intention], Glance] = {}

    def start(self, plan: HumanPlan) -> Start:
        """The initial state, which they know, with a plan in mind."""
        return Start(self.packed.init, self.packed.init, self.intends(plan))

    def intends(self, actions: Sequence[int]) -> Intention:
        """The intention to do these actions, one after another."""
        found = self._end
        for action in reversed(actions):
            key = action, found
            if key not in self._intentions:
                op = self.packed.op(action)
                weight = self.weights.human[op.cost]
                cost = found.cost + self.keys.scaled_cost(weight)
                option, total = as_option(op, weight), found.weight + weight
                self._intentions[key] = Intention(op, option, total, cost, found)
            found = self._intentions[key]
        return found

    def look(self, expected: int, state: int, intention: Intention, *, settled: bool) -> tuple[int, Glance]:
        """Step 1: what they believe after a look at the true state, and what they decide.

        Args:
            settled: see :class:`HumanStep`.
        """
        belief = self.eyes.look(expected, state)
        if settled and not (belief ^ expected) & self.concern:
            return belief, Glance(intention, intention.cost, intention.cost)
        return belief, self.decide(belief, intention)

    def goes_on(self, belief: int, state: int, look: Glance) -> HumanStep:
        """Step 3, without a joint action: they do the first step of their plan, fail in it, or wait."""
        intention = look.intention
        own = None if look.best is None else intention.op
        if own is not None and applicable(own, state):
            return HumanStep(intention.option, self.expects(belief, intention.option), intention.rest, True)
        learnt = belief if own is None else self.learn(belief, state, own)
        return HumanStep(NOTHING, self.expects(learnt, NOTHING), intention, False)

    def joins(self, joint: Operator, belief: int, look: Glance) -> HumanStep:
        """Step 2: a joint action that they have accepted."""
        option = as_option(joint, self.weights.team(joint))
        return HumanStep(option, self.expects(belief, option), look.intention, False)

    def expects(self, belief: int, own: JointAction) -> int:
        """What they expect to see after an epoch in which they do something, or nothing."""
        return belief & own.keep | own.put

    def decide(self, belief: int, intention: Intention) -> Glance:
        """Step 1: whether they keep their plan, make another, or wait."""
        key = (belief & self.concern, intention)
        if key not in self._looks:
            self._looks[key] = self._decide(belief, intention)
        return self._looks[key]

    def _decide(self, belief: int, intention: Intention) -> Glance:
        kept = intention.cost if self.works(belief, intention) else None
        limit = INFINITE_KEY if kept is None else self.keys.of_scaled(kept)
        best = self.alone.key(belief, limit)
        if best >= limit:
            return Glance(intention, kept, kept)
        plan = canonical(self.alone, belief)
        return Glance(self.intends(plan), kept, self.keys.scaled_cost(best))

    def works(self, belief: int, intention: Intention) -> bool:
        """Whether a plan leads from what they believe to their goal, with robots idle."""
        at, state = intention, belief
        while at.op is not None:
            after = self.follows(state, at.option) if applicable(at.op, state) else None
            if after is None:
                return False
            at, state = at.rest, after
        return self.packed.goal.holds(state)

    def unasked(
        self, state: int, epoch: int, belief: int, intention: Intention
    ) -> Iterable[HumanStep] | None:
        """Their part of the epoch after ``epoch``, without a look; None where they look up."""
        return None

    def paid(self, part: JointAction, waited: int) -> tuple[JointAction, int]:
        """Their part of an epoch with the waiting before it, and the weight of what is not yet paid for."""
        return part, 0

    def accepts(self, joint: Operator, belief: int, best: int | None) -> bool:
        """Step 2: whether the human takes part, ``best`` being their cost alone now."""
        after = self.follows(belief, as_option(joint, 0)) if applicable(joint, belief) else None
        if after is None:
            return False
        if best is None:
            return True  # anything may be worth more than no plan at all
        left = best - self.keys.scaled_cost(self.weights.human[joint.cost])
        if left < 0:
            return False
        limit = self.keys.of_scaled(left + 1)
        return self.alone.key(after, limit) < limit

    def follows(self, state: int, part: JointAction) -> int | None:
        """The state after an epoch in which they do something, others nothing new; None where it can't."""
        return state & part.keep | part.put

    def stuck(self, state: int) -> bool:
        """Whether the human has no plan alone from a packed state, as it truly is."""
        return self.alone.key(state) >= INFINITE_KEY

    def learn(self, belief: int, state: int, op: Operator) -> int:
        """The belief after the human tried an action in vain: its preconditions as they are."""
        mask = asked_by(op)
        return belief & ~mask | state & mask


def _packing(
    prepared: PreparedTask, actions: Collection[int], deadline: Deadline, *, local: bool, told: bool
) -> TaskTables:
    """The task packed as the human sees it, with what the actions ask for."""
    if told:
        return prepared.complete(deadline)
    plain = prepared.with_diversions(deadline)
    missing = _missing(plain.packed, actions)
    if local:
        return prepared.doubting(missing, deadline) if missing else prepared.doubtful(deadline)
    return prepared.including(missing, deadline, prepared.diversions(deadline)) if missing else plain


def _missing(packed: PackedTask, actions: Collection[int]) -> frozenset[int]:
    """Facts to pack for actions that can't contribute to a goal, but may be done or tried."""
    task = packed.task
    asked = asked_facts(task, actions)
    missing = set(asked) if any(packed.fact_bits[f] is None for f in asked) else set()
    for i in actions:
        action = task.actions[i]
        if action.participants == (task.human,) and not packed.is_useful(i):
            missing |= {*action.pre, *action.neg, *action.add, *action.delete}
    return frozenset(missing)
