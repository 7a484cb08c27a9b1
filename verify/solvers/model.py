"""Integer programs, as the encodings write them: columns and rows, in flat tables.

Writing a program is what takes time and memory before a solver starts, so a :class:`Model`
polls a deadline while it grows.
"""

from array import array
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import NamedTuple

from serendipity.model import Deadline

Terms = Mapping[int, int]
"""A linear expression: integer coefficients by column."""


@dataclass(frozen=True, slots=True)
class ModelRow:
    """One linear constraint ``terms sense right``."""

    terms: Terms
    sense: str
    right: int


class Model:
    """An integer program with bounded columns and an integral objective to minimise.

    Args:
        deadline: polled while the program is written.
        presolve: lets HiGHS reduce it first: programs of flows are solved faster without.

    Attributes:
        lower: least value of each column.
        upper: greatest value of each column.
        integral: whether a column has to be integral; a continuous one is wherever the others are.
        objective: coefficients by column.
        index: columns of all rows' terms, one row after the other.
        coefficients: their coefficients.
        ends: for each row, the end of its terms in both.
        heads: for each row, its sense and right-hand side.
        families: for each row, what it stands for.
        family: what the rows that are added next stand for.
    """

    def __init__(self, deadline: Deadline | None = None, *, presolve: bool = False) -> None:
        self.presolve = presolve
        self.lower: list[int] = []
        self.upper: list[int] = []
        self.integral: list[bool] = []
        self.objective: dict[int, int] = {}
        self.index = array("i")
        self.coefficients: list[int] = []
        self.ends: list[int] = []
        self.heads: list[tuple[str, int]] = []
        self.families: list[str] = []
        self.family = ""
        self._deadline = deadline or Deadline()

    def binary(self) -> int:
        """A new column with the values 0 and 1 (eq. 13, 14)."""
        return self.column(0, 1)

    def column(self, lower: int, upper: int, *, integral: bool = True) -> int:
        """The index of a new column with bounds.

        Args:
            integral: whether only whole values count.
        """
        self._deadline.tick()
        self.lower.append(lower)
        self.upper.append(upper)
        self.integral.append(integral)
        return len(self.upper) - 1

    def add(self, terms: Terms, sense: str, right: int) -> None:
        """A new row."""
        self._deadline.check()  # most of the work was to find its terms
        self.index.extend(terms)
        self.coefficients.extend(terms.values())
        self.ends.append(len(self.index))
        self.heads.append((sense, right))
        self.families.append(self.family)

    @property
    def rows(self) -> Iterator[ModelRow]:
        """The rows, one by one."""
        start = 0
        for end, (sense, right) in zip(self.ends, self.heads, strict=True):
            terms = dict(zip(self.index[start:end], self.coefficients[start:end], strict=True))
            yield ModelRow(terms, sense, right)
            start = end


def largest(model: Model, deadline: Deadline) -> int:
    """The largest absolute value of all numbers in a program."""
    numbers = (model.objective.values(), (right for _, right in model.heads), model.coefficients)
    return max(map(abs, deadline.each(chain(*numbers))), default=0)


class SolverAnswer(NamedTuple):
    """What a solver says, in its own figures.

    Attributes:
        status: ``optimal``, ``infeasible``, a limit as in ``LimitReachedError.reason``, or words of its own.
        values: of the columns, or None.
        bound: lower bound on the objective, or None.
    """

    status: str
    values: list[float] | None = None
    bound: float | None = None
