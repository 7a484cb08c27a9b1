"""States packed into one Python int: a bit field per finite-domain variable.

An action is then two masks to test and two to apply, whatever the number of
facts.  Only facts that some useful action or a goal can ask for are packed;
conflicts between actions are still judged on their declared effects (semantics 2).

*Leader* is the agent under whom an op is looked up: the human if they take part.
"""

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from copy import copy
from dataclasses import dataclass
from functools import cached_property

from search.packed.operator_index import by_most_asked
from search.packed.operators import Operator, Signature, asked_by, forms_of, set_by, split, union
from search.packed.relevance import deeds_of, relevant_to_goals
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition, conflicting
from serendipity.model.task.task import Task
from serendipity.model.task.unit_steps import CLOCK, RESTING, WAITING


@dataclass(frozen=True, slots=True)
class PackedGoal:
    """A packed condition."""

    need_mask: int
    need: int
    forbidden: tuple[tuple[int, int], ...]

    @property
    def mask(self) -> int:
        """The fields that the condition looks at."""
        return self.need_mask | union(field for field, _ in self.forbidden)

    def within(self, fields: int) -> "PackedGoal":
        """What it asks of some fields."""
        forbidden = tuple((field, value) for field, value in self.forbidden if field & fields)
        return PackedGoal(self.need_mask & fields, self.need & fields, forbidden)

    def holds(self, state: int) -> bool:
        """Whether the packed state satisfies the condition."""
        if state & self.need_mask != self.need:
            return False
        return not self.forbidden or all(state & mask != value for mask, value in self.forbidden)


class PackedTask:
    """Packed form of a task.

    Args:
        extra: ids of facts to pack although no useful action asks for them.
        kept: ids of actions to pack although they contribute to nothing.

    Attributes:
        useful: ids of the actions that can contribute to a goal or an ``extra`` fact, or are ``kept``.
        fact_bits: per fact id its field's mask and value, or None where it is not packed.
        fields: masks of the fields.
        costs: the different undiscounted costs of the task's actions, ascending.
        human_bit: the human in a bit set of agents.
        own: useful ops that the human does alone and that some state allows.
        joint: those in which the human and others take part.
        others: those without the human.
        own_forms, joint_forms, other_forms: the same by their forms.
        own_index: ``own`` by their busiest field.
        joint_index: ``joint`` by theirs.
        robot_indices: ``others`` by theirs, an index for each first participant.
    """

    @no_collection()
    def __init__(
        self, task: Task, extra: frozenset[int], deadline: Deadline, kept: tuple[int, ...] = ()
    ) -> None:
        self.task = task
        self.human_bit = 1 << task.human
        self._agents: dict[tuple[int, ...], int] = {}
        relevant, useful = relevant_to_goals(task, extra, deadline, (*kept, *deeds_of(task), *_priced(task)))
        self.useful = useful
        self.fact_bits: list[tuple[int, int] | None] = [None] * len(task.facts)
        self.fields: list[int] = []
        self._values: dict[int, list[int]] = {0: [0]}
        shift = 0
        for variable in task.variables:
            deadline.check()  # a place may have thousands of facts
            if not any(f in relevant for f in variable.facts):
                continue
            codes = range(2 if variable.boolean else len(variable.facts))
            width = (len(codes) - 1).bit_length()
            mask = (1 << width) - 1 << shift
            for fact, code in zip(variable.facts, codes[variable.boolean :], strict=True):
                self.fact_bits[fact] = (mask, code << shift)
            self.fields.append(mask)
            self._values[mask] = [code << shift for code in codes]
            shift += width
        self._by_lowest_bit = {field & -field: field for field in self.fields}
        self.boolean = {f for v in task.variables if v.boolean for f in v.facts}
        # Deleting a value of a group clears nothing: what is added instead does.
        self._cleared = [
            bits[0] if bits is not None and fact in self.boolean else 0
            for fact, bits in enumerate(self.fact_bits)
        ]
        self.all_ones = (1 << shift) - 1
        self.init = self.pack(task.init)
        self.goal = self.condition(task.goal)
        self.robot_goal = self.condition(task.robot_goal)
        self.at_rest = self.condition(Condition(tuple(f for f in task.at_rest if self.fact_bits[f])))
        # By ratio: the hash of a rational takes four times as long as all else about a cost.
        self.costs = tuple(sorted({a.cost.as_integer_ratio(): a.cost for a in task.actions}.values()))
        self._cost_index = {cost.as_integer_ratio(): i for i, cost in enumerate(self.costs)}
        self._ops: dict[int, Operator] = {}
        self._sort_by_actor(deadline)

    def at(self, task: Task) -> "PackedTask":
        """The same packing for a task that differs in its initial state only."""
        moved = copy(self)
        moved.task = task
        moved.init = moved.pack(task.init)
        return moved

    def for_goal(self, task: Task) -> "PackedTask":
        """The same packing for a task that differs in its goals, over packed facts, only."""
        other = copy(self)
        other.task = task
        other.goal, other.robot_goal = other.condition(task.goal), other.condition(task.robot_goal)
        return other

    def _sort_by_actor(self, deadline: Deadline) -> None:
        human, ops = self.human_bit, map(self.op, deadline.each(self.useful))
        possible = [op for op in ops if op.need >= 0]  # some state passes its test
        self.own = tuple(op for op in possible if op.agents == human)
        self.joint = tuple(op for op in possible if op.agents & human and op.agents != human)
        self.others = tuple(op for op in possible if not op.agents & human)
        self.own_forms = forms_of(self.own, self.all_ones, deadline)
        self.joint_forms = forms_of(self.joint, self.all_ones, deadline)
        self.other_forms = forms_of(self.others, self.all_ones, deadline)
        robots = sum(1 << robot for robot in self.task.robots)
        led: dict[int, list[Signature]] = {}
        for form in self.other_forms:
            if form.agents & -form.agents & robots:  # not bystanders, who follow the script
                led.setdefault(form.agents & -form.agents, []).append(form)
        self.own_index = by_most_asked(self.own_forms, self.fields, deadline)
        self.joint_index = by_most_asked(self.joint_forms, self.fields, deadline)
        self.robot_indices = tuple(
            by_most_asked(forms, self.fields, deadline) for _, forms in sorted(led.items())
        )

    @cached_property
    def due(self) -> tuple[tuple[int, int, Operator], ...]:
        """Fields and values, each with what has to be done in the next epoch where it is so."""
        placed = ((self.fact_bits[fact], action) for fact, action in self.task.due)
        return tuple((*bits, self.op(action)) for bits, action in placed if bits is not None)

    @cached_property
    def _due_at(self) -> dict[tuple[int, int], Operator]:
        return {(field, value): op for field, value, op in self.due if op.agents != self.clock_bit}

    def following(self, op: Operator) -> Operator | None:
        """What is due after an epoch of an action; None after its last."""
        if not self.task.due:
            return None
        sets = self.assigned(self.all_ones & ~op.keep, op.put)
        return next((self._due_at[at] for at in sets if at in self._due_at), None)

    def chain(self, op: Operator) -> tuple[Operator, ...]:
        """An action from one of its epochs on to its last."""
        found = [op]
        while (following := self.following(found[-1])) is not None:
            found.append(following)
        return tuple(found)

    @cached_property
    def clock_bit(self) -> int:
        """The clock's bit in sets of agents; 0 where there is no script."""
        agents = self.task.agents
        return 1 << agents.index(CLOCK) if CLOCK in agents else 0

    @cached_property
    def scripted(self) -> tuple[Operator, ...]:
        """What others do by the script, or are in the middle of at first, and what the clock changes."""
        clock = {field for field, _, op in self.due if op.agents == self.clock_bit}
        begun = [op for field, _, op in self.due if field in clock and not op.agents & self.human_bit]
        chains = [(op,) if op.agents == self.clock_bit else self.chain(op) for op in begun]
        return tuple(op for chain in chains for op in chain)

    @cached_property
    def freedom(self) -> int:
        """The fields that say who is at nothing, where actions take time; last epochs do not need them."""
        task = self.task
        free = {
            *task.at_rest,
            *(f for f in task.goal.positive if task.facts[f] == f"free {task.agents[task.human]}"),
        }
        placed = (self.fact_bits[fact] for fact in free if task.due)
        return union(bits[0] for bits in placed if bits is not None)

    @cached_property
    def lasting(self) -> int:
        """All fields but those that say who is at what, and which epoch it is."""
        clock = (field for field, _, op in self.due if op.agents == self.clock_bit)
        return self.all_ones & ~self.freedom & ~next(clock, 0)

    @cached_property
    def idling(self) -> tuple[int, ...]:
        """Ids of the human's waiting as an action; of several the last is free, and ends what they do."""
        last = self.task.actions[-2:]
        first = len(self.task.actions) - len(last)
        return tuple(i for i, a in enumerate(last, start=first) if a.name in (WAITING, RESTING))

    @property
    def prices_waiting(self) -> bool:
        """Whether waiting costs the human something: then it is among their actions."""
        return len(self.idling) > 1

    @cached_property
    def _uncounted(self) -> frozenset[int]:
        return frozenset((*self.idling, *(action for _, action in self.task.due)))

    def counted(self, action: int) -> int:
        """1 where an action is begun by choice; 0 where it goes on, or is waiting."""
        return int(action not in self._uncounted)

    @cached_property
    def awake(self) -> int:
        """The fields that say whether the human may begin anything, where waiting costs; 0 elsewhere."""
        return self.op(self.idling[0]).need_mask if self.prices_waiting else 0

    @property
    def in_time(self) -> bool:
        """Whether it makes a difference in which epochs plans are, and not only in which order."""
        return bool(self.task.due) or self.prices_waiting

    @cached_property
    def outside(self) -> int:
        """The fields that some op without the human sets."""
        return set_by(self.other_forms)

    @cached_property
    def own_mask(self) -> int:
        """The fields that what the human does alone asks for or sets."""
        return union(form.mentions for form in self.own_forms)

    def involves_others(self, agents: int, fields: int) -> bool:
        """Whether others than the human take part, or change some of the fields."""
        return agents != self.human_bit or bool(fields & self.outside)

    def pack(self, state: Iterable[int]) -> int:
        """The packed form of a set of true facts."""
        placed = (self.fact_bits[fact] for fact in state)
        return union(bits[1] for bits in placed if bits is not None)

    def values(self, field: int) -> list[int]:
        """The values that a field can have, in place."""
        return self._values[field]

    def split(self, mask: int) -> Iterator[int]:
        """The fields in a union of fields, ascending."""
        return split(mask, self._by_lowest_bit)

    def assigned(self, mask: int, state: int) -> Iterator[tuple[int, int]]:
        """The fields in a union of fields, each with what a packed state has there."""
        return ((field, state & field) for field in split(mask, self._by_lowest_bit))

    def condition(self, condition: Condition) -> PackedGoal:
        """The packed form of a conjunction of literals over packed facts."""
        return PackedGoal(*self._literals(condition.positive, condition.negative))

    def op(self, action_id: int) -> Operator:
        """The packed form of an action, made when first asked for."""
        op = self._ops.get(action_id)
        if op is None:
            op = self._ops[action_id] = self._pack_action(action_id)
        return op

    def effect(self, action_id: int) -> tuple[int, int]:
        """``s & keep | put``: what an action does to what is packed, whatever it asks for."""
        action = self.task.actions[action_id]
        clear = put = 0
        for fact in action.delete:
            clear |= self._cleared[fact]
        for fact in action.add:
            bits = self.fact_bits[fact]
            if bits is not None:
                clear |= bits[0]
                put |= bits[1]
        return self.all_ones & ~clear, put

    def is_useful(self, action_id: int) -> bool:
        """Whether an action is packed: it can contribute to something."""
        place = bisect_left(self.useful, action_id)
        return place < len(self.useful) and self.useful[place] == action_id

    def compatible(self, first: int, second: int, strict: bool) -> bool:
        """Whether two actions may share an epoch (semantics 2)."""
        actions = self.task.actions
        return not conflicting(actions[first], actions[second], strict=strict)

    def mentioned(self, op: Operator) -> int:
        """The fields that an op asks for or sets."""
        return asked_by(op) | self.all_ones & ~op.keep

    def changed_by(self, ops: Iterable[Operator]) -> int:
        """The union of the fields that some of ``ops`` set."""
        return union(self.all_ones & ~op.keep for op in ops)

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
            if need_mask & mask and need & mask != value:
                impossible = True
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

    def _pack_action(self, action_id: int) -> Operator:
        action = self.task.actions[action_id]
        need_mask, need, forbidden = self._literals(action.pre, action.neg)
        keep, put = self.effect(action_id)
        agents = self._agents.get(action.participants)
        if agents is None:
            agents = self._agents[action.participants] = sum(1 << agent for agent in action.participants)
        cost = self._cost_index[action.cost.as_integer_ratio()]
        return Operator(need_mask, need, keep, put, forbidden, action_id, agents, cost)


def _priced(task: Task) -> Iterator[int]:
    """Ids of all that the human takes part in where waiting costs: anything may be cheaper than that."""
    if task.actions and task.actions[-1].name == RESTING:
        yield from (i for i, action in enumerate(task.actions) if task.human in action.participants)
