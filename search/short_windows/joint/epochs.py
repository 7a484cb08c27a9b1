"""States epoch by epoch in the kernel: what all agents can make of the world beside the human's timetable."""

import ctypes
from array import array
from collections import defaultdict
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from typing import Final, NamedTuple

from search.call.context import SearchContext
from search.classical.encoded_problem import EncodedProblem, memory_for
from search.classical.like_fields import Exchange, like_fields, told
from search.classical.planner import FOUND, RUNNING, SLICE, ClassicalPlanner, with_memory
from search.classical.problem import ClassicalProblem
from search.packed.operators import Operator, union
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task

_NONE: Final = -1
"""No operator."""


class Leaving(NamedTuple):
    """Something that can be left behind by the end of an epoch.

    Attributes:
        total: what it costs, with a lower bound on what follows.
        paid: without that.
        number: by which it is asked for.
    """

    total: int
    paid: int
    number: int


class Epochs:
    """Layers of states, and what one more epoch can leave behind; amounts are costs and numbers of actions.

    Args:
        context: of the call, whose actions may not share an epoch, from whose initial state it begins.
        problem: of the whole team, with amounts for weights.
        after: what follows; asked for bounds.
        lost: by field masks the values from which nothing can follow.
        unit: what a unit of its costs is in amounts.

    Attributes:
        is_hopeless: whether a state has more sets than are gone through.

    Raises:
        LimitReachedError: there is not enough memory.
    """

    def __init__(
        self,
        library: ctypes.CDLL,
        context: SearchContext,
        problem: ClassicalProblem,
        after: ClassicalPlanner,
        lost: Mapping[int, Collection[int]],
        unit: int,
        deadline: Deadline,
    ) -> None:
        task = context.task
        self._kernel, self._after, self.is_hopeless = library, after, False
        self._told = EncodedProblem(problem)
        self._numbers = {op.action: number for number, op in enumerate(problem.operators)}
        self._operators = problem.operators
        self._given: list[int] = []
        self._fields = [field for field, _ in problem.fields]
        deadline.require(memory_for(problem) + len(problem.operators) ** 2)
        human, last = 1 << task.human, 1 << len(task.agents)
        acting = (op.agents for op in problem.operators)  # the human's bit is to be the last one
        agents = array("Q", [bits & ~human | (last if bits & human else 0) for bits in acting])
        apart = conflicts(task, problem.operators, deadline, strict=context.options.strict)
        self._alike = _alike(problem, after, apart, lost, deadline)
        planner, mask = after.handle, after.told.row(after.problem.mask)
        size = -(-len(apart) // 64) * 8
        rows = b"".join([row.to_bytes(size, "little") for row in apart])
        flags = b"".join(_flags(field, values, lost.get(field, ())) for field, values in problem.fields)
        self._epochs = library.epochs_new(
            ctypes.byref(self._told.spec), agents.buffer_info()[0], rows, planner, mask, flags, unit
        )
        if not self._epochs:
            raise LimitReachedError("memory-limit")
        self._is_under_way = False
        init = self._told.row(context.packed.init)
        self._allowed(lambda room: library.epochs_start(self._epochs, init, room), deadline)

    def __del__(self) -> None:
        if getattr(self, "_epochs", None):
            self._kernel.epochs_delete(self._epochs)

    @property
    def states(self) -> int:
        """How many were met so far, ends included."""
        return int(self._kernel.epochs_states(self._epochs))

    def advance(self, op: Operator, later: int, limit: int, most: int, deadline: Deadline) -> bool:
        """Go on by an epoch in which an operator is given.

        Args:
            later: the fields that matter to those that may be given in later epochs.
            limit: amount from which on nothing is of interest.
            most: states.

        Returns:
            Whether the states are no more than that; if they are, the same call goes on.

        Raises:
            LimitReachedError: the deadline came; the same call goes on.
        """
        number = self._numbers[op.action]
        alike = [[one for one in others if not self._fields[one] & later] for others in self._alike]
        done = self._run(number, limit, most, deadline, alike)
        if done:
            self._given.append(number)
        return done

    def leave(self, limit: int, most: int, deadline: Deadline) -> list[Leaving] | None:
        """What can be left behind by an epoch in which all are free, the least total first.

        None: there are more states; the same call goes on.  What an earlier epoch could leave behind
        for less is not told again.  Arguments as above.
        """
        if not self.end_all(limit, most, deadline):
            return None
        kernel, epochs = self._kernel, self._epochs
        count = kernel.epochs_leavings(epochs, None, None)
        totals, paid = array("q", bytes(8 * count)), array("q", bytes(8 * count))
        kernel.epochs_leavings(epochs, totals.buffer_info()[0], paid.buffer_info()[0])
        return sorted(map(Leaving, totals, paid, range(count)))

    def end_all(self, limit: int, most: int, deadline: Deadline) -> bool:
        """Go through such an epoch; arguments, and what is said, as for :meth:`advance`."""
        return self._run(_NONE, limit, most, deadline)

    def go_back(self, limit: int, deadline: Deadline) -> None:
        """Find out what is left from all states, once all epochs were gone through, under no lower limits."""
        given, outcome = array("i", self._given or [0]), RUNNING
        while outcome == RUNNING:
            deadline.check()
            outcome = self._kernel.epochs_back(self._epochs, given.buffer_info()[0], limit, SLICE)

    def rest(self, epochs: int, state: int, *, at_once: bool = False) -> int | None:
        """Bound on what is left from a packed state after some epochs; None where it was not met.

        It is no more than what of the limit was left there.

        Args:
            at_once: if something is left behind by the next epoch.
        """
        found = self._kernel.epochs_rest(self._epochs, epochs, self._told.row(state), at_once)
        return None if found == _NONE else int(found)

    def end(self, leaving: Leaving) -> int:
        """The packed state that is left behind, in the fields that matter to what follows."""
        row = ctypes.create_string_buffer(self._after.told.size)
        self._kernel.epochs_left(self._epochs, leaving.number, row)
        return int.from_bytes(row.raw, "little")

    def ways(self, leaving: Leaving) -> list[list[Operator]]:
        """What is done in each epoch for something that is left behind."""
        room = (len(self._given) + 1) * (max(op.agents for op in self._operators).bit_length() + 2)
        given, found = array("i", self._given or [0]), array("i", bytes(4 * room))
        count = self._kernel.epochs_sets(
            self._epochs, leaving.number, given.buffer_info()[0], found.buffer_info()[0]
        )
        sets: list[list[Operator]] = [[]]
        for number in found[: count - 1]:  # a set may be empty
            if number == _NONE:
                sets.append([])
            else:
                sets[-1].append(self._operators[number])
        return sets

    def _run(
        self, given: int, limit: int, most: int, deadline: Deadline, alike: Sequence[Sequence[int]] = ()
    ) -> bool:
        """Go through an epoch, from where that was interrupted, if it was."""
        kernel, epochs = self._kernel, self._epochs
        ones = told(alike)
        if not self._is_under_way and not kernel.epochs_turn(epochs, given, ones.buffer_info()[0], len(ones)):
            raise LimitReachedError("memory-limit")
        self._is_under_way, outcome = True, RUNNING
        while outcome == RUNNING and self.states <= most:
            deadline.check()
            outcome = self._allowed(lambda room: kernel.epochs_slice(epochs, limit, SLICE, room), deadline)
        self._is_under_way = outcome != FOUND
        self.is_hopeless = outcome not in (RUNNING, FOUND)
        return not self._is_under_way

    def _allowed(self, call: Callable[[int], int], deadline: Deadline) -> int:
        return with_memory(call, lambda: self._kernel.epochs_wanted(self._epochs), deadline)


def _alike(
    problem: ClassicalProblem,
    after: ClassicalPlanner,
    apart: Sequence[int],
    lost: Mapping[int, Collection[int]],
    deadline: Deadline,
) -> list[list[int]]:
    """Classes of fields that are alike to all agents, and to what follows."""

    def allows(exchange: Exchange) -> bool:
        partners = {1 << number: 1 << other for number, other in exchange.items()}
        moved = sum(partners)

        def exchanged(row: int) -> int:
            found, left = row & ~moved, row & moved
            while left:
                bit = left & -left
                found, left = found | partners[bit], left ^ bit
            return found

        pairs = exchange.items()
        return all(exchanged(apart[number]) == apart[other] for number, other in pairs if number <= other)

    fields = [field for field, _ in after.problem.fields]
    later = {fields[one]: alike[0] for alike in after.alike(deadline) for one in alike}
    later |= dict.fromkeys({field for field, _ in problem.fields} - {*fields}, _NONE)
    found = defaultdict[Hashable, list[int]](list)
    for number, alike in enumerate(like_fields(problem, deadline, allows)):
        for one in alike:
            field = problem.fields[one][0]
            values = frozenset(value // (field & -field) for value in lost.get(field, ()))
            found[number, later.get(field, (one,)), values].append(one)
    return [*found.values()]


def _flags(field: int, values: int, chosen: Collection[int]) -> bytes:
    """For each value of a field 1 if it is among some."""
    lowest = field & -field
    return bytes(value * lowest in chosen for value in range(values))


def conflicts(task: Task, operators: Sequence[Operator], deadline: Deadline, *, strict: bool) -> list[int]:
    """By operator those, as bits, with which it may not share an epoch (semantics 2), but for agents."""
    actions = [task.actions[op.action] for op in operators]
    adding, deleting = _by_fact([a.add for a in actions]), _by_fact([a.delete for a in actions])
    needing, barred = _by_fact([a.pre for a in actions]), _by_fact([a.neg for a in actions])
    found = []
    for action in deadline.each(actions):
        row = union(deleting[fact] | adding[fact] | needing[fact] * strict for fact in action.delete)
        row |= union(deleting[fact] | barred[fact] * strict for fact in action.add)
        if strict:
            row |= union(deleting[fact] for fact in action.pre) | union(adding[fact] for fact in action.neg)
        found.append(row)
    return found


def _by_fact(sets: Sequence[Collection[int]]) -> dict[int, int]:
    """By fact the sets, as bits, that it is in."""
    found = defaultdict[int, int](int)
    for number, facts in enumerate(sets):
        for fact in facts:
            found[fact] |= 1 << number
    return found
