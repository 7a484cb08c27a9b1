"""The kernel on one classical problem: optimal costs, lower bounds, a first plan.

What it learns of states serves later questions: exact costs along plans, and of every state that was
expanded that it costs no less than what was left then (Koenig and Likhachev 2005).  A question that turns
out to be hard goes to symbolic search for a while.
"""

import ctypes
from array import array
from collections.abc import Callable, Iterable
from copy import copy
from functools import partial
from math import inf
from typing import Final

from search.classical.encoded_problem import EncodedProblem, memory_for
from search.classical.like_fields import like_fields, told
from search.classical.problem import ClassicalProblem
from search.engine.astar import AStar
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operators import applicable
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

SLICE: Final = 0.004
"""Seconds between two looks at the deadline."""

ROOM: Final = 1 << 24
"""Bytes that may be allocated before memory is asked for again."""

_SOME: Final = 100
"""Evaluations after which it is worth its time to find out what is alike: it takes as long."""

_MUCH_WORK: Final = 100_000_000
"""Evaluations times operators, two to four seconds, after which symbolic search has its turn."""

_SYMBOLIC_SHARE: Final = 0.5
"""What of the time that is left it may take."""

_SOON: Final = 0.05
"""Seconds in which a known plan is put together where a limit has come."""

_STEPS: Final = 16
"""Steps of a known plan between two looks at the deadline: tens of milliseconds of plans of thousands."""

RUNNING, FOUND, _NOT_BELOW, _HOPELESS, MEMORY, _UNFIT = range(6)


def with_memory(call: Callable[[int], int], wanted: Callable[[], int], deadline: Deadline) -> int:
    """The outcome of a call of the kernel, given as much memory as it wants.

    Args:
        call: the call, by how many bytes may be allocated.
        wanted: the bytes that were missing.
        deadline: asked for them.

    Raises:
        LimitReachedError: there is not that much.
    """
    outcome = call(ROOM)
    while outcome == MEMORY:
        missing = wanted()
        deadline.require(missing)
        outcome = call(missing)
    return outcome


class ClassicalPlanner:
    """The kernel on one problem, with all that it has learnt.

    Attributes:
        told: the same, as the kernel is told of it.
        handle: what the kernel knows it by.
        is_open: whether a limit came during the last :meth:`cheapest`, which can :meth:`go_on`.

    Raises:
        LimitReachedError: there is not enough memory.
    """

    def __init__(self, library: ctypes.CDLL, problem: ClassicalProblem, deadline: Deadline) -> None:
        self.problem = problem
        self._kernel = library
        self._mask = problem.mask
        deadline.require(memory_for(problem))
        self.told = EncodedProblem(problem)
        self.handle: int | None = None
        self._alike: list[list[int]] | None = None
        """Classes of fields, by their numbers, once they were looked for."""
        self._start()

    def __del__(self) -> None:
        if getattr(self, "handle", None):
            self._kernel.planner_free(self.handle)

    def _start(self) -> None:
        if self.handle:
            self._kernel.planner_free(self.handle)
        self.handle = self._kernel.planner_new(ctypes.byref(self.told.spec))
        if not self.handle:
            raise LimitReachedError("memory-limit")
        self._tried = 0.0
        self._tell_alike(self._alike or [], Deadline())
        self._asked: int | None = None
        self._most = INFINITE_KEY
        self._floor = 0
        """What symbolic search says that no plan of the last question weighs less than."""
        self._plans: dict[int, list[int]] = {}
        """Those that the kernel does not know, by the state where they begin."""
        self._canonical: set[int] = set()
        """States of which these are canonical."""
        self.is_open = False

    def anew(self, deadline: Deadline) -> "ClassicalPlanner":
        """Another one on the same problem, which has learnt nothing yet."""
        deadline.require(memory_for(self.problem))
        other = copy(self)
        other.handle = None
        other._start()
        return other

    # -- questions

    def cheapest(
        self,
        state: int,
        deadline: Deadline,
        limit: int = INFINITE_KEY,
        on_bound: Callable[[int], None] | None = None,
    ) -> int:
        """The amount of a cheapest plan from a packed state; any value from ``limit`` on means "not below".

        Args:
            limit: what is dearer does not matter.
            on_bound: told now and then what no plan is cheaper than.
        """
        self._asked, self._most, self._floor = state & self._mask, limit, 0
        self._begin(deadline)
        return self.go_on(deadline, on_bound)

    def _begin(self, deadline: Deadline) -> None:
        assert self._asked is not None, "a question was asked"
        kernel, planner = self._kernel, self.handle
        row, most = self.told.row(self._asked), self.problem.limit(self._most)
        self.is_open = False
        self._allowed(lambda room: kernel.planner_begin(planner, row, most, room), deadline)
        self.is_open = True

    def go_on(self, deadline: Deadline, on_bound: Callable[[int], None] | None = None) -> int:
        """What the last :meth:`cheapest` would have said, where a limit came first: it goes on from there.

        Meanwhile only :meth:`bound` and :meth:`first_plan` may have been asked for.
        """
        kernel, planner = self._kernel, self.handle
        assert self.is_open, "it was interrupted"
        outcome = RUNNING
        while outcome == RUNNING:
            seconds = SLICE / 4 if self._alike is None else SLICE  # then it begins anew: as soon as may be
            outcome = self._allowed(partial(kernel.planner_run, planner, seconds), deadline)
            if outcome != RUNNING:
                break
            deadline.check()
            if on_bound is not None:
                on_bound(self.least)
            if self._alike is None and self.counts()[2] >= _SOME:
                self.alike(deadline)
            if self._is_settled_symbolically(deadline, on_bound):
                break
        found = self._unbounded(deadline) if outcome == _UNFIT else self.least
        self.is_open = False
        return found

    def _is_settled_symbolically(self, deadline: Deadline, on_bound: Callable[[int], None] | None) -> bool:
        """Ask a symbolic search, if it is worth its time by now; whether it has settled the question.

        Where time was short it is asked again once there is twice as much.
        """
        if self._tried == inf or self.counts()[2] * len(self.problem.operators) < _MUCH_WORK:
            return False
        part = deadline.part(_SYMBOLIC_SHARE)
        seconds = inf if (left := part.left()) is None else left
        if seconds < 2 * self._tried:
            return False
        self._tried = seconds
        from search.classical import symbolic  # only here: few calls need it

        if not symbolic.is_installed():
            self._tried = inf
            return False

        def noted(weight: int) -> None:
            self._floor = weight
            if on_bound is not None:
                on_bound(self.least)

        start = self._asked
        assert start is not None, "a search is under way"
        try:
            plan = symbolic.cheapest_plan(self.problem, start, self.problem.limit(self._most), part, noted)
        except (MemoryError, OSError):
            self._tried = inf
            return False
        except LimitReachedError:
            deadline.check()
            return False
        if plan is not None:
            self._plans[start] = plan
            self._canonical.add(start)
        return True

    def _unbounded(self, deadline: Deadline) -> int:
        """:meth:`cheapest` in Python, whose integers have no end: plans may cost more than it adds up."""
        problem, start = self.problem, self._asked
        assert start is not None, "a search is under way"
        amounts = [problem.amount(weight) for weight in problem.weights]
        search = AStar(start, lambda _: 0, deadline, limit=self._most)
        for state, spent in search:
            if problem.goal.holds(state):
                self._plans[start] = [number for _, number in search.way_back(state)][::-1]
                return spent
            for number, op in enumerate(problem.operators):
                after = (state & op.keep | op.put) & self._mask
                if applicable(op, state):
                    search.reach(after, spent + amounts[number], state, number)
        return INFINITE_KEY if search.least is None else self._most

    @property
    def least(self) -> int:
        """The amount that no plan from the state of the last :meth:`cheapest` is below, finished or not."""
        return self.problem.amount(max(self._floor, self._kernel.planner_least(self.handle)))

    def bound(self, state: int, deadline: Deadline) -> int:
        """An amount that no plan from a packed state is below; ``INFINITE_KEY`` where there is none.

        Raises:
            LimitReachedError: there is not enough memory.
        """
        kernel, planner, row = self._kernel, self.handle, self.told.row(state)
        found = kernel.planner_bound(planner, row, ROOM)
        if found < 0:
            deadline.require(kernel.planner_wanted(planner))
            found = kernel.planner_bound(planner, row, kernel.planner_wanted(planner))
        return self.problem.amount(found)

    def first_plan(self, state: int, deadline: Deadline) -> list[int] | None:
        """Some plan from a packed state, by numbers of operators, or None where there is none."""
        kernel, planner, row = self._kernel, self.handle, self.told.row(state)
        self._allowed(lambda room: kernel.planner_begin_greedy(planner, row, room), deadline)
        outcome = RUNNING
        while outcome == RUNNING:
            deadline.check()
            outcome = self._allowed(lambda room: kernel.planner_run_greedy(planner, SLICE, room), deadline)
        if outcome != FOUND:
            return None
        return self._numbers(lambda *to: kernel.planner_greedy_way(planner, *to))

    def cheapest_plan(
        self,
        state: int,
        deadline: Deadline,
        limit: int = INFINITE_KEY,
        on_bound: Callable[[int], None] | None = None,
    ) -> list[int] | None:
        """A cheapest plan from a packed state, by numbers of operators, or None where none is below a limit.

        Which of several does not depend on what was asked before: all that was learnt is forgotten.
        """
        if self._asked is not None:
            self._start()
        found = self.cheapest(state, deadline, limit, on_bound)
        return self.known_plan(state, deadline) if found < limit else None

    def is_canonical(self, state: int) -> bool:
        """Whether :meth:`known_plan` is the canonical one anyway."""
        return state & self._mask in self._canonical

    def amount(self, numbers: Iterable[int]) -> int:
        """The amount of operators, one after another."""
        weights = self.problem.weights
        return sum(self.problem.amount(weights[number]) for number in numbers)

    def known_plan(self, state: int, deadline: Deadline) -> list[int] | None:
        """A cheapest plan, by numbers, from a packed state of which the cost was found and is finite."""
        if state & self._mask in self._plans:
            return self._plans[state & self._mask]
        kernel, planner, row = self._kernel, self.handle, self.told.row(state)
        moving, part = ctypes.create_string_buffer(row, len(row)), array("i", bytes(4 * _STEPS))
        found: list[int] = []
        while True:
            deadline.check()
            count = int(kernel.planner_known_way(planner, moving, part.buffer_info()[0], _STEPS))
            if count < 0:
                return None
            found += part[:count]
            if count < _STEPS:
                return found

    def best_so_far(self, state: int) -> list[int] | None:
        """The best plan from a packed state that is at hand, by numbers: what the last :meth:`cheapest`
        has come across, finished or not, or else a cheapest one, if it is put together soon.
        """
        kernel, planner = self._kernel, self.handle
        if self._asked == state & self._mask and self._asked not in self._plans:
            best = self._numbers(lambda *to: kernel.planner_best_way(planner, *to))
            if best is not None:
                return best
        try:
            return self.known_plan(state, Deadline().within(_SOON))
        except LimitReachedError:
            return None

    def allowed(self, state: int) -> list[int]:
        """The numbers of the operators that a packed state allows, ascending."""
        numbers = array("i", bytes(4 * max(len(self.problem.operators), 1)))
        count = self._kernel.planner_allowed(self.handle, self.told.row(state), numbers.buffer_info()[0])
        return numbers[:count].tolist()

    def counts(self) -> tuple[int, int, int]:
        """How many states were expanded, generated and evaluated so far."""
        found = array("q", (0, 0, 0))
        self._kernel.planner_counts(self.handle, found.buffer_info()[0])
        return found[0], found[1], found[2]

    def _numbers(self, ask: Callable[[int, int], int]) -> list[int] | None:
        """Numbers that the kernel writes to an address, as many as it says; None where it says -1."""
        length = ask(0, 0)
        if length < 0:
            return None
        numbers = array("i", bytes(4 * max(length, 1)))
        ask(numbers.buffer_info()[0], length)
        return numbers[:length].tolist()

    def _allowed(self, call: Callable[[int], int], deadline: Deadline) -> int:
        return with_memory(call, lambda: self._kernel.planner_wanted(self.handle), deadline)

    def alike(self, deadline: Deadline) -> list[list[int]]:
        """Classes of fields that are alike, by their numbers; the kernel is told of them.

        A search that is under way begins anew.
        """
        if self._alike is None:
            found = like_fields(self.problem, deadline)
            self._tell_alike(found, deadline)
            self._alike = found
            if found and self.is_open:
                self._begin(deadline)
        return self._alike

    def _tell_alike(self, classes: list[list[int]], deadline: Deadline) -> None:
        if classes:
            kernel, planner, fields = self._kernel, self.handle, told(classes)
            at, count = fields.buffer_info()
            self._allowed(lambda room: kernel.planner_alike(planner, at, count, room), deadline)
