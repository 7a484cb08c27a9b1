"""The human alone in time, from action to action: epochs in which nothing can begin cost nothing.

They lose nothing where they begin an action as soon as it can be done from start to end: whatever they do
later they may do as early, and wait.  Where others change or ask for what the action touches, it may also
begin when that makes a difference (:mod:`search.human.agenda`).  Being there at an earlier epoch, at no
higher cost, is as good for the same reason.  So a search has no node for epochs of walks, or of waiting,
and keeps few of those that differ in their epochs alone.
"""

from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cached_property
from heapq import heappop, heappush
from itertools import count, groupby
from typing import NamedTuple

from search.human.agenda import Agenda, Course
from search.human.individual_planner import FoundPlan, IndividualPlanner, Memory, TakenOverError
from search.human.pattern_database import GoalBound
from search.packed.cost_vector import INFINITE_KEY, Weights
from search.packed.due import Due, as_one
from search.packed.operator_index import OperatorIndex, by_most_asked
from search.packed.operators import Operator, set_by, union
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.resources.deadline import Deadline


class Stride(NamedTuple):
    """An action of the human's from its first epoch to its last.

    Attributes:
        need_mask, need, forbidden: what it asks for at first of what nobody else changes meanwhile.
        keep, put: what it does.
        weight: of all its epochs.
        ops: one for each.
        script: from which of its epochs on, for how many, it asks what of fields that are known by epoch.
    """

    need_mask: int
    need: int
    forbidden: tuple[tuple[int, int], ...]
    keep: int
    put: int
    weight: int
    ops: tuple[Operator, ...]
    script: tuple[tuple[int, int, PackedGoal], ...]


class _Label(NamedTuple):
    """A way to a state: what it weighs, its epochs, its actions by the epoch in which they begin."""

    weight: int
    epochs: int
    begun: tuple[tuple[int, int], ...]
    state: int


class _Beside(NamedTuple):
    """What happens beside a way.

    Attributes:
        agenda: of the state in which it starts, or of one before.
        course: how that goes on.
        first: its epoch at the start of the way.
        end: the first one that can't be.
    """

    agenda: Agenda
    course: Course
    first: int
    end: int


class StridingPlanner(IndividualPlanner):
    """An :class:`.IndividualPlanner` that goes from action to action, where :func:`may_stride`."""

    def __init__(
        self, packed: PackedTask, bound: GoalBound, memory: Memory, deadline: Deadline, prices: Weights
    ) -> None:
        super().__init__(packed, packed.goal, bound, memory, deadline, prices)
        self._agendas: dict[int, tuple[Agenda, int]] = {}
        """By what is due what happens from there on, as that of an agenda's epoch."""
        self._indices: dict[tuple[int, int], OperatorIndex[Stride]] = {}
        self._begins: dict[tuple[int, Agenda, Course], list[int | None]] = {}

    @cached_property
    def _due(self) -> Due:
        return Due(self._packed, self._memory.weight, strict=self._memory.strict)

    def _beside(self, state: int) -> _Beside:
        at = state & self._due.deciding
        if at not in self._agendas:
            strict = self._memory.strict
            agenda = Agenda(self._packed, self._due, state, self._deadline, strict=strict)
            for epoch, progress in enumerate(agenda.progress):
                self._agendas.setdefault(progress, (agenda, epoch))
        agenda, first = self._agendas[at]
        course = agenda.course(state, first)
        return _Beside(agenda, course, first, agenda.end(state, course, first))

    def _strides(self, fields: int, known: int) -> OperatorIndex[Stride]:
        """What may begin, by the busiest field of the human's own ops that is not left out.

        Args:
            fields: what is left out of what is asked for at first.
            known: of these what an agenda knows by epoch.
        """
        found = self._indices.get((fields, known))
        if found is None:
            packed, left = self._packed, [field for field in self._packed.fields if not field & fields]
            index = by_most_asked(packed.own_forms, left, self._deadline)
            found = self._indices[fields, known] = OperatorIndex(index.field)
            found.always = [*self._begun_by(index.always, fields, known)]
            found.by_value = {
                value: [*self._begun_by(ops, fields, known)] for value, ops in index.by_value.items()
            }
        return found

    def _begun_by(self, ops: Sequence[Operator], fields: int, known: int) -> Iterator[Stride]:
        return (self._stride(op, fields, known) for op in ops if self._packed.counted(op.action))

    def _stride(self, first: Operator, fields: int, known: int) -> Stride:
        """An action from its first op on; no state allows it where none allows all of it."""
        ops = self._packed.chain(first)
        asked, own = list[PackedGoal](), list[Operator]()
        for op in ops:
            condition = PackedGoal(op.need_mask, op.need, op.forbidden)
            asked.append(condition.within(known))
            theirs = condition.within(~fields)
            own.append(op._replace(need_mask=theirs.need_mask, need=theirs.need, forbidden=theirs.forbidden))
        whole = as_one(self._packed, own)
        weight = sum(map(self._memory.weight, ops))
        return Stride(*whole[:2], whole.forbidden, *whole[2:4], weight, ops, tuple(_together(asked)))

    def _onward(self, label: _Label, beside: _Beside) -> Iterator[_Label]:
        """What may be done next, each as soon as it makes a difference that it can be done to its end."""
        agenda, course, first, end = beside
        state, now, awake = label.state, first + label.epochs, self._packed.awake
        is_open, known = agenda.is_open(now), agenda.fields
        strides = self._strides(known if is_open else known | agenda.shared, known)
        for stride in strides.candidates(state):
            if state & stride.need_mask != stride.need:
                continue
            if any(state & field == value for field, value in stride.forbidden):
                continue
            for begins in self._beginnings(stride, beside, now):
                waited, ends = begins - now, begins + len(stride.ops)
                if ends > end or (waited and state & awake != awake):
                    break
                after: int | None = (state & stride.keep | stride.put) & ~known | agenda.at(course, ends)
                if not is_open:
                    after = agenda.passed(state, course, now, begins, stride.ops)
                if after is None or (agenda.stuck(after, ends) and not self._goal.holds(after)):
                    continue
                weight = label.weight + waited * self._waiting_weight + stride.weight
                start = label.epochs + waited
                begun = (*label.begun, (start, stride.ops[0].action))
                yield _Label(weight, start + len(stride.ops), begun, after)
                if not ~stride.keep & agenda.touched:
                    break  # nobody minds how early it is

    def _until_goal(self, label: _Label, beside: _Beside) -> _Label | None:
        """Waiting for the goal, where it comes by itself; None where it does not."""
        agenda, course, first, end = beside
        now, state = first + label.epochs, label.state
        if not self._goal.mask & (agenda.fields | agenda.shared):
            return None
        moments = agenda.moments(course, self._goal.mask)
        for moment in moments[bisect_right(moments, now) :]:
            after = None if moment > end else agenda.passed(state, course, now, moment)
            if after is None:
                break
            if self._goal.holds(after):
                waited = moment - now
                weight = label.weight + waited * self._memory.weight(self._packed.op(self._packed.idling[-1]))
                return _Label(weight, label.epochs + waited, label.begun, after)
        return None

    def _beginnings(self, stride: Stride, beside: _Beside, now: int) -> Iterator[int]:
        """Epochs in which an action may begin, ascending: now, and when others make a difference to it."""
        agenda, course, *_ = beside
        edges: Sequence[int] = () if agenda.is_open(now) else agenda.begins(stride.ops)
        soonest = self._soonest(stride, agenda, course) if stride.script else None
        before = -1
        for epoch in (now, *edges[bisect_right(edges, now) :]):
            found = epoch if soonest is None else soonest[min(epoch, agenda.last)]
            if found is None:
                return
            if max(epoch, found) != before:
                before = max(epoch, found)
                yield before

    def _soonest(self, stride: Stride, agenda: Agenda, course: Course) -> list[int | None]:
        """By epoch when an action can begin at the soonest, by what is known by epoch."""
        key = stride.ops[0].action, agenda, course
        found = self._begins.get(key)
        if found is None:
            last, soonest = agenda.last, None
            rows = [(first, epochs, agenda.lengths(course, asked)) for first, epochs, asked in stride.script]
            found = []
            for epoch in range(last, -1, -1):
                if all(row[min(epoch + first, last)] >= epochs for first, epochs, row in rows):
                    soonest = epoch
                found.append(soonest)
            found.reverse()
            self._begins[key] = found
        return found

    @cached_property
    def _waiting_weight(self) -> int:
        return self._memory.weight(self._packed.op(self._packed.idling[0]))

    def _search(self, start: int, limit: int) -> int:
        """See :class:`.IndividualPlanner`: exact below ``limit``."""
        freed = self._due.finished(start)
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
        return weight + found.weight

    def canonical(self, state: int) -> FoundPlan | None:
        """See :class:`.IndividualPlanner`."""
        if self._memory.classical is not None:
            return super().canonical(state)
        freed = self._due.finished(state & self.mask)
        before = self._memory.expanded
        try:
            found = None if freed is None else self._best(freed[0], INFINITE_KEY, in_order=True)
        except TakenOverError:
            return super().canonical(state)
        if freed is None or found is None:
            return None
        actions = [*freed[2]]
        waiting, resting = self._packed.idling[0], self._packed.idling[-1]
        for start, action in found.begun:
            actions += [waiting] * (start + len(freed[2]) - len(actions))
            actions += (op.action for op in self._packed.chain(self._packed.op(action)))
        actions += [resting] * (found.epochs + len(freed[2]) - len(actions))
        return FoundPlan(tuple(actions), self._memory.expanded - before, 0)

    def _best(self, start: int, limit: int, *, in_order: bool) -> _Label | None:
        """A best way to the goal that weighs less than a limit; None where there is none.

        Args:
            start: a packed state in which the human is free.
            in_order: of the best ones the one of fewest actions, and then the canonical one.
        """
        beside = self._beside(start)
        outside = ~beside.agenda.fields
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
            if not self._goal.holds(label.state) and label not in fronts[label.state & outside]:
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
            last = self._until_goal(label, beside)
            if last is not None and last.weight < limit:
                heappush(queue, (last.weight, next(ticket), last))
            for after in self._onward(label, beside):
                bound = after.weight + self._estimate(after.state)
                if bound >= limit:
                    continue
                front = fronts.get(after.state & outside, [])
                if any(self._covers(known, after, beside, in_order=in_order) for known in front):
                    continue
                kept = [known for known in front if not self._covers(after, known, beside, in_order=in_order)]
                fronts[after.state & outside] = [*kept, after]
                heappush(queue, (bound, next(ticket), after))
        return best

    def _covers(self, known: _Label, other: _Label, beside: _Beside, *, in_order: bool) -> bool:
        """Whether whatever comes of another label may as well come of a known one."""
        caught_up, agenda, first = known.weight, beside.agenda, beside.first
        if agenda.last:
            if known.epochs > other.epochs:
                return False
            edges, sooner, later = agenda.edges, first + known.epochs, first + other.epochs
            if bisect_right(edges, sooner) != bisect_right(edges, later):
                return False  # one is between them
            # After the last epoch nothing depends on which it is, so that nobody waits for one.
            waited = min(other.epochs, agenda.last - first) - known.epochs
            caught_up += max(0, waited) * self._waiting_weight
        if caught_up != other.weight or not in_order:
            return caught_up <= other.weight
        return len(known.begun) <= len(other.begun) and known.begun <= other.begun


def _order(label: _Label) -> tuple[int, int, tuple[tuple[int, int], ...]]:
    return label.weight, len(label.begun), label.begun


def _together(asked: Sequence[PackedGoal]) -> Iterator[tuple[int, int, PackedGoal]]:
    """Conditions by epoch, those together that go on."""
    first = 0
    for condition, same in groupby(asked):
        epochs = len([*same])
        if condition.mask:
            yield first, epochs, condition
        first += epochs


def may_stride(packed: PackedTask, *, strict: bool) -> bool:
    """Whether the human alone may go from action to action.

    What others are to do is told by fields of their own, and they have one way to do it.
    """
    begun = Counter((field, value, packed.task.actions[op.action].name) for field, value, op in packed.due)
    deciding = union(field for field, _, op in packed.due if not op.agents & packed.human_bit)
    own = packed.own_mask if strict else set_by(packed.own_forms)
    return bool(begun) and max(begun.values()) == 1 and not deciding & own


def is_undisturbed(packed: PackedTask) -> bool:
    """Whether nothing but facts happens beside the human alone, and none that they or a goal ask to last.

    The script changes nothing that they do, or that a goal asks for, no bystander has a plan, and nobody is
    in the middle of anything.
    """
    clock = next((field for field, _, op in packed.due if op.agents == packed.clock_bit), 0)
    if any(field == clock and op.agents != packed.clock_bit for field, _, op in packed.due):
        return False
    robots = sum(1 << robot for robot in packed.task.robots)
    if any(op.agents & ~(robots | packed.human_bit | packed.clock_bit) for _, _, op in packed.due):
        return False
    scripted = packed.changed_by(op for _, _, op in packed.due if op.agents == packed.clock_bit)
    return not scripted & (set_by(packed.own_forms) | packed.goal.mask | packed.robot_goal.mask)
