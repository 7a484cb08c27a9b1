"""What robots must leave alone: the plan that the person is following, and what any other would cost.

Nobody knows which plan a person is following.  Robots take it to be one that was the canonical choice
when there was none as cheap, and that they have kept to since.  Such a plan works after every epoch,
unless the person drops it anyway, because what robots have done has made another one cheaper, and they
see that.  Somebody may be following another plan that is just as cheap.  So whatever they do next that
begins a cheapest plan, the rest must not get dearer by what robots do meanwhile.  Hence a person who
replans when that is cheaper, or has to, never pays more than they would have alone.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

from search.human.individual_planner import canonical
from search.modes.simulation.human import Human, Intention, Start
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operators import Operator, applicable
from serendipity.model import Condition, HumanPlan, Options, Task


class Following:
    """The plans that the person may be following towards one goal.

    Where a deadline comes first, methods raise :class:`serendipity.LimitReachedError`.

    Args:
        human: the person, as robots imagine them.
        state: ids of the facts that are true in the beginning, as the person knows.
        options: the person's model, and what may share an epoch.

    Attributes:
        plans: their steps that are left: those that were predicted, the oldest first.
    """

    def __init__(self, human: Human, state: frozenset[int], options: Options) -> None:
        self.plans: tuple[Intention, ...] = ()
        self._human = human
        self._sees_all = options.human_model == "observant"
        self._strict = options.strict
        self._task = human.packed.task
        self._state = self._belief = human.packed.pack(state)

    @property
    def hopeless(self) -> bool:
        """Whether they have no plan alone."""
        return not self.plans

    def start_of(self, human: Human) -> Start:
        """Where they are, what they believe, and what they go on with, for a human who is packed alike."""
        return Start(self._state, self._belief, human.intends(self.promise()))

    def look(self, state: frozenset[int], habit: HumanPlan | None = None) -> None:
        """The person looks up.

        Args:
            state: ids of the facts that are true.
            habit: what they go on with as long as it works, though another way be cheaper.
        """
        human = self._human
        self._state = human.packed.pack(state)
        self._belief = human.eyes.look(self._belief, self._state)
        plans = self.plans if habit is None else (human.intends(habit), *self.plans)
        self.plans = tuple(plan for plan in plans if human.works(self._belief, plan))
        if habit is not None and self.plans[:1] == plans[:1]:
            self.plans = plans[:1]
            return
        limit = min((human.keys.of_scaled(plan.cost) for plan in self.plans), default=INFINITE_KEY)
        if human.alone.key(self._belief, limit) < limit:  # nobody leaves a plan for one that is no cheaper
            self.plans += (human.intends(canonical(human.alone, self._belief)),)

    def promise(self) -> HumanPlan:
        """The plan that they go on with if nothing better turns up: the oldest as cheap as any, or none."""
        oldest = min(self.plans, key=lambda plan: plan.cost, default=self._human.intends(()))
        return oldest.actions

    @property
    def alone(self) -> Fraction | None:
        """What that costs; None where they have no plan."""
        return None if self.hopeless else self._task.cost_of(self.promise())

    def cost_alone(self, state: frozenset[int]) -> Fraction | None:
        """What the person pays from a state with robots idle; None where they don't get there."""
        key = self._human.alone.key(self._human.packed.pack(state))
        return None if key == INFINITE_KEY else self._human.keys.cost(key)

    def acted(self, own: int | None, executed: Iterable[int], tried: int | None = None) -> None:
        """Say what the person did: plans that begin otherwise are not theirs.

        Args:
            own: what they did by themselves.
            tried: what they found to be impossible.
        """
        human, task = self._human, self._task
        his = [i for i in executed if task.human in task.actions[i].participants]
        self._belief = _after(self._belief, map(human.packed.effect, his))
        if tried is not None and human.packed.is_useful(tried):
            self._belief = human.learn(self._belief, self._state, human.packed.op(tried))
        if own is not None:
            name = task.actions[own].name
            begun = (p for p in self.plans if p.op is not None and task.actions[p.op.action].name == name)
            self.plans = tuple(dict.fromkeys(plan.rest for plan in begun))

    def needed(self) -> Condition:
        """What the plans ask for: the preconditions of all their steps, and the goal."""
        true, false = set(self._task.goal.positive), set(self._task.goal.negative)
        for plan in self.plans:
            for i in plan.actions:
                true.update(self._task.actions[i].pre)
                false.update(self._task.actions[i].neg)
        return Condition(tuple(true), tuple(false))

    def spoilt(self, robots: Sequence[int], offers: Sequence[int], *, surely: bool = True) -> bool:
        """Whether what robots do in an epoch could spoil the plan of the person, whichever it is.

        Args:
            robots: ids of what robots do by themselves.
            offers: ids of joint actions that the person may take part in.
            surely: whether all of it takes place; else some of it may fail, or take longer.
        """
        packed, concern = self._human.packed, self._human.concern
        others = [_Other(i, *packed.effect(i)) for i in robots]
        touching = [other for other in others if packed.all_ones & ~other.keep & concern]
        sizes = (len(touching),) if surely else range(1, len(touching) + 1)
        return any(
            any(self._loses(op, some) for op in packed.own) or any(self._worse(i, some) for i in offers)
            for size in sizes
            if size
            for some in combinations(touching, size)
        )

    def _loses(self, op: Operator, others: Sequence["_Other"]) -> bool:
        """Whether a plan that goes on with a step of the person's is spoilt, or what is left gets dearer."""
        human, state = self._human, self._state
        rests = [plan.rest for plan in self.plans if plan.op is not None and plan.op.action == op.action]
        if not applicable(op, state):
            return False  # tried in vain, whatever robots do
        alone = _after(state, [_does(op)])
        begins = self._begins(op, alone)
        if not (rests or begins):
            return False  # not the way to go
        if self._conflict(op, others):
            return True
        then = _after(state, [_does(op), *map(_does, others)])
        left = human.alone.key(then)
        if begins and left >= human.keys.of_scaled(human.keys.scaled_cost(human.alone.key(alone)) + 1):
            return True
        return any(
            human.works(alone, rest)
            and not human.works(then, rest)
            and not (self._sees_all and left < human.keys.of_scaled(rest.cost))
            for rest in rests
        )

    def _begins(self, op: Operator, after: int) -> bool:
        """Whether a cheapest plan begins with a step of the person's, after which a state is reached."""
        human = self._human
        least = human.alone.key(self._state)
        if least >= INFINITE_KEY:
            return False
        rest = human.keys.scaled_cost(least) - human.keys.scaled_cost(human.weights.human[op.cost])
        return rest >= 0 and human.alone.key(after, limit := human.keys.of_scaled(rest + 1)) < limit

    def _worse(self, offer: int, others: Sequence["_Other"]) -> bool:
        """Whether what is left is dearer by what robots do, if the person takes part in an action."""
        op = self._human.packed.op(offer)
        if not applicable(op, self._state):
            return False
        if self._conflict(op, others):
            return True
        least = self._human.alone.key(_after(self._state, [_does(op)]))
        then = _after(self._state, [_does(op), *map(_does, others)])
        return self._human.alone.key(then, least + 1) > least

    def _conflict(self, op: Operator, others: Sequence["_Other"]) -> bool:
        packed = self._human.packed
        return not all(packed.compatible(op.action, other.action, self._strict) for other in others)


class _Other(NamedTuple):
    """What somebody else does in an epoch: its id, and what it does to what is packed."""

    action: int
    keep: int
    put: int


def _does(action: Operator | _Other) -> tuple[int, int]:
    return action.keep, action.put


def _after(state: int, effects: Iterable[tuple[int, int]]) -> int:
    """The state after some actions in one epoch."""
    kept, put = -1, 0
    for keep, adds in effects:
        kept &= keep
        put |= adds
    return state & kept | put


class RobotActions:
    """What robots can do in a task, by what it would spoil.

    Attributes:
        all: ids of everything that robots take part in.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self.all = self.of(task.robots)
        self._alone = [i for i in self.all if task.human not in task.actions[i].participants]

    def spoiling(self, needed: Condition) -> frozenset[int]:
        """Ids of what robots can do by themselves that would make something needed untrue."""
        true, false = frozenset(needed.positive), frozenset(needed.negative)
        own = ((i, self._task.actions[i]) for i in self._alone)
        return frozenset(i for i, a in own if not (true.isdisjoint(a.delete) and false.isdisjoint(a.add)))

    def of(self, robots: Iterable[int]) -> frozenset[int]:
        """Ids of everything that some robots take part in."""
        chosen = frozenset(robots)
        return frozenset(i for i, a in enumerate(self._task.actions) if not chosen.isdisjoint(a.participants))
