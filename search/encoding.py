"""States packed into one Python int: a bit field per finite-domain variable.

An action is then two masks to test and two to apply, whatever the number of
facts.  Only facts that some useful action or a goal can ask for are packed;
conflicts between actions are still judged on their declared effects (SPEC 2).

Glossary: *field* - the bits of one variable; *op* - a packed ground action;
*leader* - the agent under whom an op is looked up (the human if he takes part).
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from copy import copy
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Concatenate, NamedTuple, ParamSpec, TypeVar

from search.clock import Clock
from search.relevance import relevant_to_goals
from serendipity.model.actions import Condition, conflicting
from serendipity.model.collection import no_collection
from serendipity.model.task import Task

T = TypeVar("T")
P = ParamSpec("P")


class Op(NamedTuple):
    """A packed ground action: applicable iff ``s & need_mask == need`` and no ``s & m == v``
    of ``forbidden``; its successor is ``s & keep | put``.
    """

    need_mask: int
    need: int
    keep: int
    put: int
    forbidden: tuple[tuple[int, int], ...]
    action: int
    agents: int
    """Bit set of its participants."""
    cost: int
    """Index of its undiscounted cost in ``Encoding.costs``."""


class OpIndex:
    """Ops of one leader by the value of one field: the one that most of them ask for."""

    __slots__ = ("always", "by_value", "field")

    def __init__(self, ops: Sequence[Op], fields: Sequence[int], clock: Clock) -> None:
        asked = _asked_for(ops, fields, clock)
        self.field = max(fields, key=lambda field: asked[field], default=0)
        self.by_value: dict[int, list[Op]] = {}
        self.always: list[Op] = []
        field = self.field
        for op in ops:
            if op.need_mask & field:
                self.by_value.setdefault(op.need & field, []).append(op)
            else:
                self.always.append(op)

    def candidates(self, state: int) -> list[Op]:
        """Ops whose condition on the field holds in a packed state."""
        return self.by_value.get(state & self.field, []) + self.always


def _asked_for(ops: Sequence[Op], fields: Sequence[int], clock: Clock) -> Counter[int]:
    """How many ops ask for each field; linear in what they ask for."""
    by_lowest_bit = {field & -field: field for field in fields}
    asked: Counter[int] = Counter()
    for op in ops:
        clock.tick()
        left = op.need_mask
        while left:
            field = by_lowest_bit[left & -left]
            asked[field] += 1
            left &= ~field
    return asked


def applicable(op: Op, state: int) -> bool:
    """Whether an op's precondition holds in a packed state."""
    return state & op.need_mask == op.need and all(state & m != value for m, value in op.forbidden)


@dataclass(frozen=True, slots=True)
class Goal:
    """A packed condition."""

    need_mask: int
    need: int
    forbidden: tuple[tuple[int, int], ...]

    @property
    def mask(self) -> int:
        """The fields that the condition looks at."""
        mask = self.need_mask
        for field, _ in self.forbidden:
            mask |= field
        return mask

    def holds(self, state: int) -> bool:
        """Whether the packed state satisfies the condition."""
        if state & self.need_mask != self.need:
            return False
        return not self.forbidden or all(state & mask != value for mask, value in self.forbidden)


class Encoding:
    """Packed form of a task.

    Args:
        task: the task.
        extra: ids of facts to pack although no useful action asks for them.
        clock: asked for time.

    Attributes:
        useful: ids of the actions that can contribute to a goal or an ``extra`` fact.
        fact_bits: per fact id its field's mask and value, or None where it is not packed.
        fields: masks of the fields.
        costs: the different undiscounted costs of the task's actions, ascending.
        human_bit: the human in a bit set of agents.
        own: useful ops that the human does alone.
        joint: useful ops in which the human and others take part.
        others: useful ops without the human.
        own_index: ``own`` by their busiest field.
        joint_index: ``joint`` by theirs.
        robot_indices: ``others`` by theirs, an index for each first participant.
    """

    def __init__(self, task: Task, extra: frozenset[int], clock: Clock) -> None:
        self.task = task
        self.human_bit = 1 << task.human
        self._agents: dict[tuple[int, ...], int] = {}
        with no_collection():
            self._build(task, extra, clock)

    def _build(self, task: Task, extra: frozenset[int], clock: Clock) -> None:
        relevant, useful = relevant_to_goals(task, extra, clock)
        self.useful = useful
        self.fact_bits: list[tuple[int, int] | None] = [None] * len(task.facts)
        self.fields: list[int] = []
        self._values: dict[int, list[int]] = {0: [0]}
        shift = 0
        for variable in task.variables:
            if not any(f in relevant for f in variable.facts):
                continue
            width = 1 if variable.boolean else max(1, (len(variable.facts) - 1).bit_length())
            mask = (1 << width) - 1 << shift
            for code, fact in enumerate(variable.facts):
                value = 1 if variable.boolean else code
                self.fact_bits[fact] = (mask, value << shift)
            self.fields.append(mask)
            codes = range(2) if variable.boolean else range(len(variable.facts))
            self._values[mask] = [code << shift for code in codes]
            shift += width
        self.boolean = {f for v in task.variables if v.boolean for f in v.facts}
        self.all_ones = (1 << shift) - 1
        self.init = self.pack(task.init)
        self.goal = self.condition(task.goal)
        self.robot_goal = self.condition(task.robot_goal)
        self.costs = task.derived(_distinct_costs)
        self._cost_index = {cost: i for i, cost in enumerate(self.costs)}
        self._cost_by_identity: dict[int, int] = {}
        self._ops: dict[int, Op] = {}
        self._compatible: dict[tuple[int, int, bool], bool] = {}
        self._derived: dict[Any, Any] = {}
        self._sort_by_actor(clock)

    def moved_to(self, task: Task, *, derived: bool) -> "Encoding":
        """The same packing for a task that differs in its initial state only.

        Args:
            task: the task.
            derived: whether what was derived from this packing holds for the state, too.
        """
        moved = copy(self)
        moved.task = task
        moved.init = moved.pack(task.init)
        if not derived:
            moved._derived = {}
        return moved

    def for_goal(self, task: Task) -> "Encoding":
        """The same packing for a task that differs in the human's goal, over packed facts, only."""
        other = copy(self)
        other.task = task
        other.goal = other.condition(task.goal)
        other._derived = {}
        return other

    def _sort_by_actor(self, clock: Clock) -> None:
        own: list[Op] = []
        joint: list[Op] = []
        led: dict[int, list[Op]] = {}
        human = self.human_bit
        for op in map(self.op, self.useful):
            clock.tick()
            if op.agents == human:
                own.append(op)
            elif op.agents & human:
                joint.append(op)
            else:
                led.setdefault(op.agents & -op.agents, []).append(op)
        self.own, self.joint = tuple(own), tuple(joint)
        self.others = tuple(op for ops in led.values() for op in ops)
        self.own_index = OpIndex(own, self.fields, clock)
        self.joint_index = OpIndex(joint, self.fields, clock)
        self.robot_indices = tuple(OpIndex(ops, self.fields, clock) for _, ops in sorted(led.items()))

    @cached_property
    def outside(self) -> int:
        """The fields that some op without the human sets."""
        return self.changed_by(self.others)

    @cached_property
    def own_mask(self) -> int:
        """The fields that what the human does alone asks for or sets."""
        mask = 0
        for op in self.own:
            mask |= self.mentioned(op)
        return mask

    def derived(self, build: "Callable[Concatenate[Encoding, P], T]", *args: P.args, **kwargs: P.kwargs) -> T:
        """``build(self, ...)``, computed once: tables that depend on nothing but the packed task.

        What else is given may only say how it is built (a clock to ask for time, say), not what.
        """
        if build not in self._derived:
            self._derived[build] = build(self, *args, **kwargs)
        return self._derived[build]  # type: ignore[no-any-return]

    def pack(self, state: Iterable[int]) -> int:
        """The packed form of a set of true facts."""
        packed = 0
        for fact in state:
            bits = self.fact_bits[fact]
            if bits is not None:
                packed |= bits[1]
        return packed

    def values(self, field: int) -> list[int]:
        """The values that a field can have, in place."""
        return self._values[field]

    def condition(self, condition: Condition) -> Goal:
        """The packed form of a conjunction of literals over packed facts."""
        return Goal(*self._literals(condition.positive, condition.negative))

    def op(self, action_id: int) -> Op:
        """The packed form of an action, made when first asked for."""
        op = self._ops.get(action_id)
        if op is None:
            op = self._ops[action_id] = self._pack_action(action_id)
        return op

    def compatible(self, first: int, second: int, strict: bool) -> bool:
        """Whether two actions may share an epoch (SPEC 2)."""
        key = (first, second, strict)
        answer = self._compatible.get(key)
        if answer is None:
            actions = self.task.actions
            answer = not conflicting(actions[first], actions[second], strict=strict)
            self._compatible[key] = answer
        return answer

    def mentioned(self, op: Op) -> int:
        """The fields that an op asks for or sets."""
        mask = op.need_mask | self.all_ones & ~op.keep
        for field, _ in op.forbidden:
            mask |= field
        return mask

    def changed_by(self, ops: Iterable[Op]) -> int:
        """The union of the fields that some of ``ops`` set."""
        mask = 0
        for op in ops:
            mask |= self.all_ones & ~op.keep
        return mask

    def _literals(
        self, positive: Iterable[int], negative: Iterable[int]
    ) -> tuple[int, int, tuple[tuple[int, int], ...]]:
        need_mask = need = 0
        forbidden = []
        impossible = False
        fact_bits = self.fact_bits
        for fact in positive:
            bits = fact_bits[fact]
            assert bits is not None, "a condition asks only for packed facts"
            mask, value = bits
            impossible |= bool(need_mask & mask) and need & mask != value
            need_mask |= mask
            need |= value
        for fact in negative:
            bits = fact_bits[fact]
            assert bits is not None, "a condition asks only for packed facts"
            mask, value = bits
            if fact in self.boolean:
                impossible |= bool(need & mask)
                need_mask |= mask
            else:
                forbidden.append((mask, value))
        # Two values of one variable: a test that no state passes.
        return need_mask, (-1 if impossible else need), tuple(forbidden)

    def _pack_action(self, action_id: int) -> Op:
        action = self.task.actions[action_id]
        need_mask, need, forbidden = self._literals(action.pre, action.neg)
        clear = put = 0
        for fact in action.delete:
            bits = self.fact_bits[fact]
            if bits is not None and fact in self.boolean:
                clear |= bits[0]
        for fact in action.add:
            bits = self.fact_bits[fact]
            if bits is not None:
                clear |= bits[0]
                put |= bits[1]
        agents = self._agents.get(action.participants)
        if agents is None:
            agents = sum(1 << agent for agent in action.participants)
            self._agents[action.participants] = agents
        cost = self._cost_class(action.cost)
        return Op(need_mask, need, self.all_ones & ~clear, put, forbidden, action_id, agents, cost)

    def _cost_class(self, cost: Fraction) -> int:
        known = self._cost_by_identity.get(id(cost))
        if known is None:  # the task keeps its costs alive, so identities don't recur
            known = self._cost_by_identity[id(cost)] = self._cost_index[cost]
        return known


def encoding(task: Task, clock: Clock) -> Encoding:
    """The encoding of the facts that matter to the goals, kept with the task."""
    return task.derived(plain_encoding, clock)


def plain_encoding(task: Task, clock: Clock) -> Encoding:
    """An encoding of the facts that matter to the goals."""
    return Encoding(task, frozenset(), clock)


def prepare(task: Task, *, afresh: bool = False) -> None:
    """Pack a task before the first call that needs it.

    Args:
        task: the task.
        afresh: forget first what earlier calls have left with it.
    """
    if afresh:
        task.forget_derived()
    encoding(task, Clock())


def full_encoding(task: Task, clock: Clock) -> Encoding:
    """The encoding that also holds every fact of the human's own domain (SPEC 3.3)."""
    return task.derived(_with_human_facts, clock)


def human_facts(task: Task) -> frozenset[int]:
    """Ids of the facts that the human's own domain mentions (SPEC 3.3)."""
    mentioned = {*task.goal.positive, *task.goal.negative}
    for i in task.human_actions:
        action = task.actions[i]
        mentioned.update(action.pre, action.neg, action.add, action.delete)
    return frozenset(mentioned)


def _with_human_facts(task: Task, clock: Clock) -> Encoding:
    return Encoding(task, human_facts(task), clock)


def _distinct_costs(task: Task) -> tuple[Fraction, ...]:
    by_identity = {id(action.cost): action.cost for action in task.actions}
    return tuple(sorted(set(by_identity.values())))
