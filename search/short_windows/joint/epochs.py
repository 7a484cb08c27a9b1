"""States epoch by epoch in the kernel: what all agents can make of the world beside the human's timetable."""

import ctypes
from array import array
from collections.abc import Callable, Collection, Sequence
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from search.call.context import SearchContext
from search.classical.encoded_problem import EncodedProblem, memory_for
from search.classical.planner import FOUND, RUNNING, SLICE, ClassicalPlanner, with_memory
from search.classical.problem import ClassicalProblem
from search.packed.operators import Operator
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task

_NONE: Final = -1
"""No operator."""

_PER_PAIR: Final = 20
"""Bytes for a pair of operators while they are compared."""


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
        lost: by field and value 1 where nothing can follow from it.
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
        lost: bytes,
        unit: int,
        deadline: Deadline,
    ) -> None:
        task = context.task
        self._kernel, self._after, self.is_hopeless = library, after, False
        self._numbers = {op.action: number for number, op in enumerate(problem.operators)}
        self._operators = problem.operators
        self._given: list[int] = []
        deadline.require(memory_for(problem) + _PER_PAIR * len(problem.operators) ** 2)
        told, agents = EncodedProblem(problem), array("Q", _human_last(task, problem.operators))
        apart = conflicts(task, problem.operators, deadline, strict=context.options.strict).tobytes()
        planner, mask = after.handle, after.told.row(after.problem.mask)
        self._epochs = library.epochs_new(
            ctypes.byref(told.spec), agents.buffer_info()[0], apart, planner, mask, lost, unit
        )
        if not self._epochs:
            raise LimitReachedError("memory-limit")
        self._is_under_way = False
        self._allowed(
            lambda room: library.epochs_start(self._epochs, told.row(context.packed.init), room), deadline
        )

    def __del__(self) -> None:
        if getattr(self, "_epochs", None):
            self._kernel.epochs_delete(self._epochs)

    @property
    def states(self) -> int:
        """How many were met so far, ends included."""
        return int(self._kernel.epochs_states(self._epochs))

    def advance(self, op: Operator, limit: int, most: int, deadline: Deadline) -> bool:
        """Go on by an epoch in which an operator is given.

        Args:
            limit: amount from which on nothing is of interest.
            most: states.

        Returns:
            Whether the states are no more than that; if they are, the same call goes on.

        Raises:
            LimitReachedError: the deadline came; the same call goes on.
        """
        number = self._numbers[op.action]
        done = self._run(number, limit, most, deadline)
        if done:
            self._given.append(number)
        return done

    def leave(self, limit: int, most: int, deadline: Deadline) -> list[Leaving] | None:
        """What can be left behind by an epoch in which all are free, the least total first.

        None: there are more states; the same call goes on.  What an earlier epoch could leave behind
        for less is not told again.  Arguments as above.
        """
        if not self._run(_NONE, limit, most, deadline):
            return None
        kernel, epochs = self._kernel, self._epochs
        count = kernel.epochs_leavings(epochs, None, None)
        totals, paid = array("q", bytes(8 * count)), array("q", bytes(8 * count))
        kernel.epochs_leavings(epochs, totals.buffer_info()[0], paid.buffer_info()[0])
        return sorted(map(Leaving, totals, paid, range(count)))

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
        return sets[::-1]

    def _run(self, given: int, limit: int, most: int, deadline: Deadline) -> bool:
        """Go through an epoch, from where that was interrupted, if it was."""
        kernel, epochs = self._kernel, self._epochs
        if not self._is_under_way and not kernel.epochs_turn(epochs, given):
            raise LimitReachedError("memory-limit")
        self._is_under_way, outcome = True, RUNNING
        while outcome == RUNNING and self.states <= most:
            deadline.check()
            self._after.prepare(deadline)
            outcome = self._allowed(lambda room: kernel.epochs_slice(epochs, limit, SLICE, room), deadline)
        self._is_under_way = outcome != FOUND
        self.is_hopeless = outcome not in (RUNNING, FOUND)
        return not self._is_under_way

    def _allowed(self, call: Callable[[int], int], deadline: Deadline) -> int:
        return with_memory(call, lambda: self._kernel.epochs_wanted(self._epochs), deadline)


def _human_last(task: Task, operators: Sequence[Operator]) -> list[int]:
    """By operator its agents as bits, of which the human's is the last one."""
    human, last = 1 << task.human, 1 << len(task.agents)
    return [op.agents & ~human | (last if op.agents & human else 0) for op in operators]


def conflicts(
    task: Task, operators: Sequence[Operator], deadline: Deadline, *, strict: bool
) -> npt.NDArray[np.bool_]:
    """By pairs of operators whether they may not share an epoch (semantics 2), but for agents."""
    actions = [task.actions[op.action] for op in operators]
    adds, deletes = _rows(task, [a.add for a in actions]), _rows(task, [a.delete for a in actions])
    found = _share(deletes, deletes, deadline) | (one_way := _share(deletes, adds, deadline)) | one_way.T
    if strict:
        falsify = _share(deletes, _rows(task, [a.pre for a in actions]), deadline)
        falsify |= _share(adds, _rows(task, [a.neg for a in actions]), deadline)
        found |= falsify | falsify.T
    return found


def _rows(task: Task, facts: Sequence[Collection[int]]) -> npt.NDArray[np.uint64]:
    """Sets of facts as rows of bits."""
    flags = np.zeros((len(facts), -(-len(task.facts) // 64) * 64), np.bool_)
    for row, listed in enumerate(facts):
        flags[row, list(listed)] = True
    return np.packbits(flags, axis=1).view(np.uint64)


def _share(
    rows: npt.NDArray[np.uint64], others: npt.NDArray[np.uint64], deadline: Deadline
) -> npt.NDArray[np.bool_]:
    """By pairs of rows whether they have a bit in common."""
    found = np.zeros((len(rows), len(others)), np.bool_)
    for column, other in zip(rows.T, others.T, strict=True):
        deadline.check()
        found |= (column[:, None] & other[None, :]) != 0
    return found
