"""The human alone in time, from action to action: epochs in which nothing can begin cost nothing.

While the human is alone, nobody but the script changes what the script changes.  So they lose nothing where
they begin an action as soon as it can be done from start to end: whatever they do later they may do as early,
and wait.  Being there at an earlier epoch, at no higher cost, is as good for the same reason.  So a search
has no node for epochs of walks, or of waiting, and keeps few of those that differ in their epochs alone.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from functools import cached_property
from heapq import heappop, heappush
from itertools import chain, count
from typing import NamedTuple

from search.human.individual_planner import FoundPlan, IndividualPlanner, TakenOverError
from search.packed.cost_vector import INFINITE_KEY
from search.packed.due import Due, as_one
from search.packed.operator_index import OperatorIndex, by_most_asked
from search.packed.operators import Operator, set_by
from search.packed.packed_task import PackedGoal, PackedTask


class Stride(NamedTuple):
    """An action of the human's from its first epoch to its last.

    Attributes:
        need_mask, need, forbidden: what it asks for at first of what the script does not change.
        keep, put: what it does.
        weight: of all its epochs.
        ops: one for each.
        script: from which of its epochs on, for how many, it asks what of the script's fields.
    """

    need_mask: int
    need: int
    forbidden: tuple[tuple[int, int], ...]
    keep: int
    put: int
    weight: int
    ops: tuple[int, ...]
    script: tuple[tuple[int, int, PackedGoal], ...]


class Script:
    """The fields of the script, as they are after each epoch while the human is alone.

    Attributes:
        clock: the field of the clock; 0 without a script.
        fields: what the script changes.
        last: the epoch after which nothing changes.
    """

    def __init__(self, packed: PackedTask) -> None:
        ticks = [(field, value, op) for field, value, op in packed.due if op.agents == packed.clock_bit]
        self.clock = ticks[0][0] if ticks else 0
        self._shift = (self.clock & -self.clock).bit_length() - 1 if ticks else 0
        self.last = len(ticks)
        self._ticks = {value >> self._shift: op for _, value, op in ticks}
        self.fields = packed.changed_by(self._ticks.values()) & ~self.clock
        self._changing = sorted(v for v, op in self._ticks.items() if ~op.keep & self.fields)
        self._courses: dict[tuple[int, int], list[int]] = {}
        self._runs: dict[tuple[int, int, PackedGoal], list[int]] = {}

    def epoch(self, state: int) -> int:
        """The epochs that are over in a packed state."""
        return (state & self.clock) >> self._shift

    def course(self, state: int) -> tuple[int, int]:
        """How the script's fields go on from a packed state: their values, and the next change."""
        return state & self.fields, bisect_right(self._changing, self.epoch(state) - 1)

    def at(self, course: tuple[int, int], epoch: int) -> int:
        """The script's fields and the clock after an epoch."""
        epoch = min(epoch, self.last)
        return self._values(course)[epoch] | epoch << self._shift if self.clock else 0

    def _values(self, course: tuple[int, int]) -> list[int]:
        found = self._courses.get(course)
        if found is None:
            value, following = course
            found, changes = [], self._changing[following:]
            for change in changes:
                found += [value] * (change + 1 - len(found))
                value = (value & self._ticks[change].keep | self._ticks[change].put) & self.fields
            found += [value] * (self.last + 1 - len(found))
            self._courses[course] = found
        return found

    def runs(self, course: tuple[int, int], condition: PackedGoal) -> list[int]:
        """By epoch for how many epochs on a condition holds; more than matter, where it does for good."""
        found = self._runs.get((*course, condition))
        if found is None:
            found, following = [], 0
            for place, value in enumerate(reversed(self._values(course))):
                following = 0 if not condition.holds(value) else following + 1 if place else 1 << 62
                found.append(following)
            found.reverse()
            self._runs[*course, condition] = found
        return found


class _Label(NamedTuple):
    """A way to a state: what it weighs, its epochs, its actions by the epoch in which they begin."""

    weight: int
    epochs: int
    begun: tuple[tuple[int, int], ...]
    state: int


class StridingPlanner(IndividualPlanner):
    """An :class:`.IndividualPlanner` that goes from action to action, where :func:`may_stride`."""

    @cached_property
    def _due(self) -> Due:
        return Due(self._packed, lambda op: self._memory.weight(op), strict=True)

    @cached_property
    def _script(self) -> Script:
        return Script(self._packed)

    @cached_property
    def _strides(self) -> OperatorIndex[Stride]:
        """What may begin, by the busiest field of the human's own ops that no script changes."""
        packed, script = self._packed, self._script
        fields = [field for field in packed.fields if not field & (script.fields | script.clock)]
        index = by_most_asked(packed.own_forms, fields, self._deadline)
        found: OperatorIndex[Stride] = OperatorIndex(index.field)
        found.always = [*self._begun_by(index.always)]
        found.by_value = {value: [*self._begun_by(ops)] for value, ops in index.by_value.items()}
        return found

    def _begun_by(self, ops: Sequence[Operator]) -> Iterator[Stride]:
        return (self._stride(op) for op in ops if self._packed.counted(op.action))

    def _stride(self, first: Operator) -> Stride:
        """An action from its first op on; no state allows it where none allows all of it."""
        packed, script = self._packed, self._script.fields | self._script.clock
        ops = packed.chain(first)
        asked, own = list[PackedGoal](), list[Operator]()
        for op in ops:
            condition = PackedGoal(op.need_mask, op.need, op.forbidden)
            asked.append(condition.within(script))
            theirs = condition.within(~script)
            own.append(op._replace(need_mask=theirs.need_mask, need=theirs.need, forbidden=theirs.forbidden))
        whole = as_one(packed, own)
        weight = sum(map(self._memory.weight, ops))
        actions = tuple(op.action for op in ops)
        return Stride(*whole[:2], whole.forbidden, *whole[2:4], weight, actions, tuple(_together(asked)))

    def _onward(self, label: _Label, course: tuple[int, int]) -> Iterator[_Label]:
        """What may be done next, each as soon as it can be done to its end."""
        script, state = self._script, label.state
        outside = ~(script.fields | script.clock)
        now, awake = script.epoch(state), self._packed.awake
        for stride in self._strides.candidates(state):
            if state & stride.need_mask != stride.need:
                continue
            if any(state & field == value for field, value in stride.forbidden):
                continue
            begins = self._soonest(stride, course, now)
            if begins is None or (begins > now and state & awake != awake):
                continue
            waited, ends = begins - now, begins + len(stride.ops)
            after = (state & stride.keep | stride.put) & outside | script.at(course, ends)
            weight = label.weight + waited * self._waiting_weight + stride.weight
            start = label.epochs + waited
            yield _Label(weight, start + len(stride.ops), (*label.begun, (start, stride.ops[0])), after)

    def _soonest(self, stride: Stride, course: tuple[int, int], now: int) -> int | None:
        """After how many epochs an action can begin, ``now`` at the soonest; None: never."""
        if not stride.script:
            return now
        known = self._begins.get((stride.ops[0], course))
        if known is None:
            known = self._begins[stride.ops[0], course] = self._beginnings(stride, course)
        return known[now]

    @cached_property
    def _begins(self) -> dict[tuple[int, tuple[int, int]], list[int | None]]:
        return {}

    def _beginnings(self, stride: Stride, course: tuple[int, int]) -> list[int | None]:
        """By epoch when an action can begin at the soonest."""
        last = self._script.last
        runs = [(first, epochs, self._script.runs(course, asked)) for first, epochs, asked in stride.script]
        found: list[int | None] = []
        soonest: int | None = None
        for epoch in range(last, -1, -1):
            if all(row[min(epoch + first, last)] >= epochs for first, epochs, row in runs):
                soonest = epoch
            found.append(soonest)
        found.reverse()
        return found

    @cached_property
    def _waiting_weight(self) -> int:
        return self._memory.weight(self._packed.op(self._packed.idling[0]))

    def _freed(self, state: int) -> tuple[int, int, tuple[int, ...]] | None:
        """The state in which they have ended what they are at, what that weighs, and its ops."""
        finished = self._due.finished(state)
        if finished is None:
            return None
        state, done = finished
        return state, sum(one.weight for one in done), tuple(one.actions[0] for one in done)

    def _search(self, start: int, limit: int) -> int:
        """See :class:`.IndividualPlanner`: exact below ``limit``."""
        freed = self._freed(start)
        if freed is None:
            self._known[start] = INFINITE_KEY
            return INFINITE_KEY
        at, weight, _ = freed
        found = self._best(at, limit - weight if limit < INFINITE_KEY else limit, in_order=False)
        if found is None:
            if limit >= INFINITE_KEY:
                self._known[start] = INFINITE_KEY
            else:
                self._at_least[start] = max(limit, self._at_least.get(start, 0))
            return limit
        self._known[start] = weight + found.weight
        return self._known[start]

    def canonical(self, state: int) -> FoundPlan | None:
        """See :class:`.IndividualPlanner`."""
        if self._memory.classical is not None:
            return super().canonical(state)
        freed = self._freed(state & self._mask)
        before = self._memory.expanded
        try:
            found = None if freed is None else self._best(freed[0], INFINITE_KEY, in_order=True)
        except TakenOverError:
            return super().canonical(state)
        if freed is None or found is None:
            return None
        actions = [*freed[2]]
        every = (*self._strides.always, *chain.from_iterable(self._strides.by_value.values()))
        strides = {stride.ops[0]: stride.ops for stride in every}
        for start, action in found.begun:
            actions += [self._packed.idling[0]] * (start + len(freed[2]) - len(actions))
            actions += strides[action]
        return FoundPlan(tuple(actions), self._memory.expanded - before, 0)

    def _best(self, start: int, limit: int, *, in_order: bool) -> _Label | None:
        """A best way to the goal that weighs less than a limit; None where there is none.

        Args:
            start: a packed state in which the human is free.
            in_order: of the best ones the one of fewest actions, and then the canonical one.
        """
        outside = ~(self._script.fields | self._script.clock)
        course, left = self._script.course(start), self._script.last - self._script.epoch(start)
        fronts: dict[int, list[_Label]] = {}
        ticket = count()
        label = _Label(0, 0, (), start)
        queue = [(self._estimate(start), next(ticket), label)]
        fronts[start & outside] = [label]
        best: _Label | None = None
        number = 0
        while queue:
            bound, _, label = heappop(queue)
            if bound >= limit:
                break
            if label not in fronts[label.state & outside]:
                continue
            self._deadline.tick()
            self._count(number)
            number += 1
            if self._goal.holds(label.state):
                if best is None or _order(label) < _order(best):
                    best = label
                if not in_order:
                    return best
                limit = label.weight + 1
                continue
            for after in self._onward(label, course):
                bound = after.weight + self._estimate(after.state)
                if bound >= limit:
                    continue
                front = fronts.get(after.state & outside, [])
                if any(self._covers(known, after, left, in_order=in_order) for known in front):
                    continue
                kept = [known for known in front if not self._covers(after, known, left, in_order=in_order)]
                fronts[after.state & outside] = [*kept, after]
                heappush(queue, (bound, next(ticket), after))
        return best

    def _covers(self, known: _Label, other: _Label, left: int, *, in_order: bool) -> bool:
        """Whether whatever comes of another label may as well come of a known one.

        Args:
            left: epochs after which nothing depends on the epoch any more, so that nobody waits for one.
        """
        caught_up = known.weight
        if self._script.clock:
            if known.epochs > other.epochs:
                return False
            caught_up += max(0, min(other.epochs, left) - known.epochs) * self._waiting_weight
        if caught_up != other.weight or not in_order:
            return caught_up <= other.weight
        return len(known.begun) <= len(other.begun) and known.begun <= other.begun


def _order(label: _Label) -> tuple[int, int, tuple[tuple[int, int], ...]]:
    return label.weight, len(label.begun), label.begun


def _together(asked: Sequence[PackedGoal]) -> Iterator[tuple[int, int, PackedGoal]]:
    """Conditions by epoch, those together that go on."""
    first = 0
    for epoch, condition in enumerate(asked):
        if epoch + 1 == len(asked) or asked[epoch + 1] != condition:
            if condition.mask:
                yield first, epoch + 1 - first, condition
            first = epoch + 1


def may_stride(packed: PackedTask) -> bool:
    """Whether the human alone may go from action to action: nothing but facts happens beside them.

    The script changes nothing that they do, or that a goal asks for, no bystander has a plan, and nobody is
    in the middle of anything.
    """
    if not packed.task.due:
        return False
    clock = next((field for field, _, op in packed.due if op.agents == packed.clock_bit), 0)
    if any(field == clock and op.agents != packed.clock_bit for field, _, op in packed.due):
        return False
    robots = sum(1 << robot for robot in packed.task.robots)
    if any(op.agents & ~(robots | packed.human_bit | packed.clock_bit) for _, _, op in packed.due):
        return False
    scripted = packed.changed_by(op for _, _, op in packed.due if op.agents == packed.clock_bit)
    return not scripted & (set_by(packed.own_forms) | packed.goal.mask | packed.robot_goal.mask)
