"""What happens beside the human alone from a packed state on: the script, and what others are at.

It is fixed by epoch, but for what the human changes too.  An epoch matters where others change something, or
ask for something else than before; all those between are the same to the human.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, combinations, groupby, pairwise
from operator import or_
from typing import NamedTuple

from search.packed.cost_vector import NEVER
from search.packed.due import Due
from search.packed.operators import Operator, changed, set_by, union
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.resources.deadline import Deadline

Course = tuple[int, int]
"""How an agenda's own fields go on: their values, and which change is next."""


class Run(NamedTuple):
    """Epochs on end in which others ask for the same, or one in which something is changed.

    Attributes:
        first, last: the epochs, from the agenda's first, which is 0.
        asked: what others ask for.
        ops: what they do.
        ticks: what the clock changes after that.
        mentioned, sets: the fields that ``ops`` ask for or set, and that all this sets.
    """

    first: int
    last: int
    asked: frozenset[PackedGoal]
    ops: tuple[Operator, ...]
    ticks: tuple[Operator, ...]
    mentioned: int
    sets: int


class Agenda:
    """What happens from a state on.

    Args:
        due: what is due in a state.
        state: packed; the human is at nothing.

    Attributes:
        progress: by epoch the fields that say what is due.
        last: the epoch from which on nothing happens.
        fields: what is changed by it, and never by the human, and what says what is due: known by epoch.
        shared: what is changed by it, and by the human too.
        runs: those in which the human may be in somebody's way, or somebody in theirs.
        edges: the epochs with which these begin, and those that follow them.
        touched: the fields that these ask for, or that are changed in them.
    """

    def __init__(self, packed: PackedTask, due: Due, state: int, deadline: Deadline, *, strict: bool) -> None:
        self._packed, self._strict = packed, strict
        self._lasting = packed.all_ones & ~due.deciding
        self._asks: dict[int, PackedGoal] = {}
        self.progress = [state & due.deciding]
        every: list[Run] = []
        self._clashes: list[int] = []
        while (found := due.at(self.progress[-1])) is not None:
            deadline.tick()
            if self._clash(found[0], self.progress[-1]):
                self._clashes.append(len(every))
            every.append(self._run(len(every), *found))
            after = changed(changed(self.progress[-1], found[0]), found[1])
            self.progress.append(after & due.deciding)
        self.last = len(every)
        own, sets = set_by(packed.own_forms), union(run.sets for run in every)
        self.fields, self.shared = sets & ~own | due.deciding, sets & own
        self._changes = [run for run in every if run.sets & self.fields]
        self._free = self._lasting & ~own
        runs = [*self._joined(every)]
        self._asking = [run for run in runs if run.asked]
        loose = self._loose(packed.own) if any(self._loose(run.ops) for run in runs) else frozenset()
        self.runs = [run for run in runs if self._meets(run, own, packed.own_mask, loose)]
        self.edges = sorted({edge for run in self.runs for edge in (run.first, run.last + 1)})
        met = [run.mentioned | run.sets for run in self.runs]
        self.touched = -1 if loose else union(met)
        self._begins: dict[int, list[int]] = {}
        self._moments: dict[tuple[Course, int], list[int]] = {}
        self._courses: dict[Course, list[int]] = {}
        self._lengths: dict[tuple[Course, PackedGoal], list[int]] = {}

    def _run(self, epoch: int, ops: Sequence[Operator], ticks: tuple[Operator, ...]) -> Run:
        """An epoch; what is nothing but the time that it takes is left out."""
        packed, lasting = self._packed, self._lasting
        ops = tuple(op for op in ops if packed.mentioned(op) & lasting or self._loose([op]))
        asked = frozenset(goal for goal in map(self._asked, ops) if goal.mask)
        mentioned = union(map(packed.mentioned, ops)) & lasting
        return Run(epoch, epoch, asked, ops, ticks, mentioned, packed.changed_by((*ops, *ticks)) & lasting)

    def _asked(self, op: Operator) -> PackedGoal:
        """What an op asks for, but for how far others are."""
        found = self._asks.get(op.action)
        if found is None:
            found = PackedGoal(op.need_mask, op.need, op.forbidden).within(self._lasting)
            self._asks[op.action] = found
        return found

    def _loose(self, ops: Iterable[Operator]) -> frozenset[int]:
        """The facts that ops change and nothing asks for: they may be in each other's way all the same."""
        actions = (self._packed.task.actions[op.action] for op in ops)
        facts = chain.from_iterable((*action.add, *action.delete) for action in actions)
        return frozenset(fact for fact in facts if self._packed.fact_bits[fact] is None)

    def _joined(self, every: Iterable[Run]) -> Iterator[Run]:
        """Epochs that are the same together, without those in which nothing happens."""

        def alike(run: Run) -> object:
            return run.asked if run.asked and not run.sets and not self._loose(run.ops) else run

        for _, group in groupby(every, key=alike):
            first, *rest = group
            if first.ops or first.sets:
                yield first._replace(last=rest[-1].last) if rest else first

    def _clash(self, ops: Sequence[Operator], progress: int) -> bool:
        """Whether others are in each other's way, or can't do what is due at once."""
        known = ~self._lasting
        if not all(PackedGoal(*op[:2], op.forbidden).within(known).holds(progress) for op in ops):
            return True
        return any(not self._fit(one, other) for one, other in combinations(ops, 2))

    def _fit(self, one: Operator, other: Operator) -> bool:
        return self._packed.compatible(one.action, other.action, self._strict)

    def _meets(self, run: Run, sets: int, mentioned: int, loose: frozenset[int]) -> bool:
        """Whether it makes a difference to a run when actions that set and mention some fields are done."""
        asked = self.shared if not self._strict else self.shared | run.mentioned
        touched = (run.mentioned | run.sets) & sets or run.sets & mentioned & asked
        return bool(touched) or not loose.isdisjoint(self._loose(run.ops))

    # -- what is known by epoch

    def course(self, state: int, epoch: int) -> Course:
        """How its own fields go on from a packed state before an epoch."""
        return state & self.fields & self._lasting, bisect_left(
            self._changes, epoch, key=lambda run: run.first
        )

    def at(self, course: Course, epoch: int) -> int:
        """Its own fields, and those that say what is due, before an epoch."""
        return self._values(course)[min(epoch, self.last)]

    def _values(self, course: Course) -> list[int]:
        found = self._courses.get(course)
        if found is None:
            value, following = course
            found = []
            for run in self._changes[following:]:
                found += [value] * (run.first + 1 - len(found))
                value = changed(changed(value, run.ops), run.ticks) & self.fields & self._lasting
            found += [value] * (self.last + 1 - len(found))
            found = self._courses[course] = list(map(or_, found, self.progress))
        return found

    def moments(self, course: Course, fields: int) -> list[int]:
        """The epochs before which one of some fields may have changed, ascending."""
        found = self._moments.get((course, fields))
        if found is None:
            pairs = enumerate(pairwise(self._values(course)), 1)
            changes = (epoch for epoch, (before, value) in pairs if (value ^ before) & fields)
            found = self._moments[course, fields] = sorted({*changes, *self.edges})
        return found

    def lengths(self, course: Course, condition: PackedGoal) -> list[int]:
        """By epoch for how many on a condition on its own fields holds; more than matter, where for good."""
        found = self._lengths.get((course, condition))
        if found is None:
            found, following = [], 0
            for place, value in enumerate(reversed(self._values(course))):
                following = 0 if not condition.holds(value) else following + 1 if place else NEVER
                found.append(following)
            found.reverse()
            self._lengths[course, condition] = found
        return found

    def end(self, state: int, course: Course, epoch: int) -> int:
        """The first epoch that is impossible from a packed state on, whatever the human does."""
        clash = next((one for one in self._clashes if one >= epoch), NEVER)
        for run in self._asking[bisect_left(self._asking, epoch, key=lambda run: run.last) :]:
            now = state & ~self.fields | self.at(course, max(run.first, epoch))
            if not all(goal.within(self._free).holds(now) for goal in run.asked):
                return min(max(run.first, epoch), clash)
        return clash

    # -- beside what the human does

    def is_open(self, epoch: int) -> bool:
        """Whether nobody is in anybody's way from an epoch on."""
        return not self.edges or epoch >= self.edges[-1]

    def begins(self, ops: Sequence[Operator]) -> list[int]:
        """Epochs in which an action may have to begin, ascending: between two of them it is all the same."""
        found = self._begins.get(ops[0].action)
        if found is None:
            loose, size = self._loose(ops), len(ops)
            sets, mentioned = self._packed.changed_by(ops), union(map(self._packed.mentioned, ops))
            met = [run for run in self.runs if self._meets(run, sets, mentioned, loose)]
            edges = {edge for run in met for edge in (run.first, run.last + 1)}
            found = sorted({edge - shift for edge in edges for shift in (0, 1, size - 1, size)})
            self._begins[ops[0].action] = found
        return found

    def stuck(self, state: int, epoch: int) -> bool:
        """Whether others can't go on with an epoch."""
        run = self._in(epoch)
        return run is not None and not all(goal.holds(state) for goal in run.asked)

    def _in(self, epoch: int) -> Run | None:
        place = bisect_left(self.runs, epoch, key=lambda run: run.last)
        return self.runs[place] if place < len(self.runs) and self.runs[place].first <= epoch else None

    def passed(
        self, state: int, course: Course, epoch: int, begins: int, ops: Sequence[Operator] = ()
    ) -> int | None:
        """The packed state after waiting and an action; None where that is impossible.

        Args:
            state: before ``epoch``.
            begins: when the action begins.
            ops: its epochs, which keep to what they ask of :attr:`fields`.
        """
        ends, own, done = begins + len(ops), ~self.fields, 0
        inside = self.edges[bisect_right(self.edges, epoch) : bisect_left(self.edges, ends)]
        for point in sorted({epoch, begins, ends - 1, *inside, begins + 1}):
            if not epoch <= point < ends:
                continue
            number, run = point - begins, self._in(point)
            mine = [] if number < 0 else [ops[number]]
            theirs, ticks = ((), ()) if run is None else (run.ops, run.ticks)
            # In between nothing but how far they are changes.
            for op in ops[done : max(0, number)]:
                state = state & op.keep | op.put
            now = state & own | self.at(course, point)
            asked = [*map(self._asked, mine), *(() if run is None else run.asked)]
            if not all(goal.holds(now) for goal in asked):
                return None
            if not all(self._fit(one, other) for one in mine for other in theirs):
                return None
            state, done = changed(changed(now, (*mine, *theirs)), ticks), max(0, number + 1)
        return state & own | self.at(course, ends)
