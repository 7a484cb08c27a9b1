"""Where all plans from a state have an even number of steps, or all an odd one.

Values of variables are black or white such that each operator turns an odd number of variables from one
colour to the other, and goals do not differ in whether they have an even number of black ones: who walks
over a grid is on a black square after every other step.  Which values are black is a system of linear
equations modulo 2.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Final

from search.classical.mutexes import Pairs
from search.classical.problem import ClassicalProblem
from search.packed.operators import Operator
from serendipity.model.resources.deadline import Deadline

_ODD: Final = 1
"""The bit of an equation for what it is equal to."""

_Value = tuple[int, int]
"""A field's mask, and what the field holds."""


class Parity:
    """Of the lengths of plans.

    Args:
        black: values of which an operator makes an odd number true or false.
        at_goals: how many of them hold in each goal, modulo 2.
        pairs: what may hold in states that can be reached.
    """

    def __init__(self, black: Iterable[_Value], at_goals: int, pairs: Pairs) -> None:
        self._black = tuple(black)
        self._at_goals = at_goals
        self._pairs = pairs

    def of(self, state: int) -> int | None:
        """The number of steps of a plan from a packed state, modulo 2; None where it is not known."""
        if not self._pairs.may_hold(self._pairs.mask, state):
            return None
        return (sum(state & field == value for field, value in self._black) + self._at_goals) % 2


def parity_of(problem: ClassicalProblem, state: int, deadline: Deadline) -> Parity | None:
    """What is known of the lengths of plans; None: nothing.

    Args:
        problem: what they are plans for.
        state: a packed state; what is known is of states that can be reached from it.
        deadline: polled.

    Raises:
        LimitReachedError: the deadline came, or there are too many values.
    """
    if not _Colours(problem).add_all(lambda op: not ~op.keep & ~op.need_mask, deadline):
        return None  # steps of which one sees what they change say so
    colours = _Colours(problem)
    colours.pairs = pairs = Pairs(colours.values.items(), problem.operators, state, deadline)
    if not colours.add_all(lambda op: pairs.may_hold(op.need_mask, op.need), deadline):
        return None
    at_goals = colours.add_goals()
    if at_goals is None:
        return None
    black = colours.equations.solution()
    return Parity(black, sum(value in black for value in at_goals), pairs)


class _Colours:
    """What has to be so for values to have such colours.

    Args:
        problem: what is to be done.

    Attributes:
        values: of each field.
        pairs: what may hold in states that can be reached, once that is known.
        equations: of values that are black.
    """

    def __init__(self, problem: ClassicalProblem) -> None:
        self._problem = problem
        self.values = {
            field: [code * (field & -field) for code in range(count)] for field, count in problem.fields
        }
        self.pairs: Pairs | None = None
        self.equations = _Equations()

    def _possible(self, mask: int, held: int, field: int) -> list[int]:
        """What a field may hold where some fields hold this."""
        if field & mask:
            return [held & field]
        assert self.pairs is not None, "it is not known what the field holds"
        return [v for v in self.values[field] if self.pairs.may_hold(mask | field, held | v)]

    def _alike(self, field: int, values: Sequence[int]) -> bool:
        """Whether values of a field may have one colour."""
        return all(self.equations.add([(field, values[0]), (field, v)], odd=False) for v in values[1:])

    def add_all(self, which: Callable[[Operator], bool], deadline: Deadline) -> bool:
        """Whether there are colours for some of the operators."""
        return all(self._add(op) for op in deadline.each(self._problem.operators) if which(op))

    def _add(self, op: Operator) -> bool:
        sides: list[_Value] = []
        for field in self.values:
            if not field & ~op.keep:
                continue
            before, after = self._possible(op.need_mask, op.need, field), op.put & field
            if not before:
                return True  # it never comes to it
            if before == [after]:
                continue
            if not self._alike(field, before):
                return False
            sides += (field, before[0]), (field, after)
        return not sides or self.equations.add(sides, odd=True)

    def add_goals(self) -> list[_Value] | None:
        """A value of each field in goals, any other being of the same colour; None: there are no colours."""
        goal, found = self._problem.goal, []
        for field in self.values:
            possible = self._possible(goal.need_mask, goal.need, field)
            if not possible or not self._alike(field, possible):
                return None
            found.append((field, possible[0]))
        return found


class _Equations:
    """Sums of unknowns modulo 2, solved one after another (Gaussian elimination)."""

    def __init__(self) -> None:
        self._bits: dict[_Value, int] = {}
        self._by_highest: dict[int, int] = {}

    def add(self, unknowns: Iterable[_Value], *, odd: bool) -> bool:
        """Whether there is still a solution where the sum of some unknowns is odd, or even."""
        row = _ODD if odd else 0
        for value in unknowns:
            row ^= self._bits.setdefault(value, _ODD << len(self._bits) + 1)
        while row > _ODD:
            known = self._by_highest.get(row.bit_length())
            if known is None:
                self._by_highest[row.bit_length()] = row
                return True
            row ^= known
        return not row

    def solution(self) -> set[_Value]:
        """The unknowns that are 1 in a solution; those that are free are 0."""
        ones = _ODD
        for highest in sorted(self._by_highest):
            if (self._by_highest[highest] & ones).bit_count() % 2:
                ones |= _ODD << highest - 1
        return {value for value, bit in self._bits.items() if bit & ones}
