"""Integer programs and the solvers behind them: the only module that touches solver objects.

A :class:`Model` is a plain list of columns and rows; PuLP hands it to HiGHS or CBC.
What a solver says is believed only as follows (PuLP 3.3):

* ``(status, sol_status) == (1, 1)`` is an optimum; a time limit also comes back as
  ``status == 1``, with ``sol_status == 2``, and proves nothing;
* ``status == -1`` is a proof that nothing satisfies the rows, since every column is bounded;
* HiGHS 1.14 is none of the versions that are asked for: its presolve removes solutions, so that
  feasible programs are called infeasible and dear solutions optimal (ERGO-Code/HiGHS #2961 and
  #3090; a test has such a program).  A model says whether a presolve is worth it at all;
* values are rounded; whoever asked re-checks the plan they stand for against the task.
"""

import logging
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from time import perf_counter
from typing import Any, Final

import pulp

from serendipity.model import UsageError

SOLVERS: Final = ("highs", "cbc")
"""Names of the solvers; the first is the default, the other the cross-check."""

LARGEST_COEFFICIENT: Final = 10**7
"""Above it a tolerance of 1e-6 could blur one unit of cost, so no proof is accepted."""

_SENSES: Final = {"<=": pulp.LpConstraintLE, ">=": pulp.LpConstraintGE, "==": pulp.LpConstraintEQ}

Terms = Mapping[int, int]
"""A linear expression: integer coefficients by column."""


@dataclass(frozen=True, slots=True)
class Row:
    """One linear constraint ``terms sense right``; ``family`` names its equation."""

    family: str
    terms: Terms
    sense: str
    right: int


@dataclass(slots=True)
class Model:
    """An integer program with bounded columns and an integral objective to minimise.

    ``presolve`` lets HiGHS reduce it first: programs of flows are solved faster without.
    """

    upper: list[int] = field(default_factory=list)
    integral: list[bool] = field(default_factory=list)
    lower: list[int] = field(default_factory=list)
    objective: dict[int, int] = field(default_factory=dict)
    rows: list[Row] = field(default_factory=list)
    presolve: bool = False

    def binary(self) -> int:
        """A new column with the values 0 and 1 (eq. 13, 14)."""
        return self.column(0, 1)

    def column(self, lower: int, upper: int, *, integral: bool = True) -> int:
        """A new column with bounds; a continuous one has to be integral wherever the others are."""
        self.lower.append(lower)
        self.upper.append(upper)
        self.integral.append(integral)
        return len(self.upper) - 1

    def add(self, family: str, terms: Terms, sense: str, right: int) -> None:
        """A new row."""
        self.rows.append(Row(family, terms, sense, right))

    @property
    def size(self) -> dict[str, int]:
        """Numbers of columns and rows, as certificates report them."""
        return {"variables": len(self.upper), "constraints": len(self.rows)}


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a solver found out.

    Attributes:
        status: ``optimal`` (``values`` is proved best), ``infeasible`` (proved) or
            ``undecided`` (``values`` may hold a solution, of which nothing is proved).
        values: one integer per column, or None.
        bound: proved lower bound on the objective, or None.
        reason: why it is undecided.
        seconds: what it took.
    """

    status: str
    values: tuple[int, ...] | None = None
    bound: float | None = None
    reason: str = ""
    seconds: float = 0.0


def solver_version(solver: str) -> str:
    """Name and version for certificates: ``HiGHS 1.13.1``."""
    if solver == "highs":
        return f"HiGHS {version('highspy')}"
    return f"CBC (PuLP {version('pulp')})"


def optimise(model: Model, *, solver: str = "highs", seconds: float | None = None) -> Outcome:
    """Minimise the model's objective, with one thread and a fixed seed.

    Args:
        solver: one of :data:`SOLVERS`.
        seconds: time limit; None for none.

    Raises:
        UsageError: there is no such solver.
    """
    if solver not in SOLVERS:
        raise UsageError(f"solver: expected one of {', '.join(SOLVERS)}, got {solver!r}")
    started = perf_counter()
    rows = []
    for row in model.rows:
        if row.terms:
            rows.append(row)
        elif not _true(row):
            return Outcome("infeasible", seconds=perf_counter() - started)
    if _largest(rows, model.objective) > LARGEST_COEFFICIENT:
        return Outcome("undecided", reason="costs need more digits than a solver's tolerance leaves")
    if seconds is not None and seconds <= 0:
        return Outcome("undecided", reason="time limit")
    if not model.upper:
        return Outcome("optimal", (), 0.0, seconds=perf_counter() - started)
    problem, columns = _problem(model, rows)
    problem.solve(_solver(solver, seconds, presolve=model.presolve))
    return _outcome(problem, columns, perf_counter() - started)


def _true(row: Row) -> bool:
    """Whether a row without columns holds."""
    return {"<=": row.right >= 0, ">=": row.right <= 0, "==": row.right == 0}[row.sense]


def _largest(rows: Iterable[Row], objective: Terms) -> int:
    largest = max((abs(value) for value in objective.values()), default=0)
    return max((max(abs(row.right), *map(abs, row.terms.values())) for row in rows), default=largest)


def _problem(model: Model, rows: Iterable[Row]) -> tuple[Any, list[Any]]:
    """PuLP's form; generated names, since PDDL names collide (coin-or/pulp #87)."""
    problem = pulp.LpProblem("m", pulp.LpMinimize)
    columns = [
        problem.add_variable(f"x{i}", low, high, pulp.LpInteger if whole else pulp.LpContinuous)
        for i, (low, high, whole) in enumerate(zip(model.lower, model.upper, model.integral, strict=True))
    ]
    # Every column is in the objective, with 0 if need be: PuLP forgets those that are nowhere.
    goal = {column: model.objective.get(i, 0) for i, column in enumerate(columns)}
    problem.setObjective(pulp.LpAffineExpression(goal))
    for number, row in enumerate(rows):
        expression = pulp.LpAffineExpression({columns[i]: c for i, c in row.terms.items()})
        problem.addConstraint(pulp.LpConstraint(expression, _SENSES[row.sense], f"c{number}", row.right))
    return problem, columns


def _solver(solver: str, seconds: float | None, *, presolve: bool) -> Any:
    """The objective is integral, so that a gap below one half is none."""
    if solver == "cbc":
        logging.getLogger("pulp").setLevel(logging.ERROR)
        options = ["randomSeed 0"]
        return pulp.COIN_CMD(
            path=_cbc_path(), msg=False, timeLimit=seconds, threads=1, gapRel=0, gapAbs=0.5, options=options
        )
    reduce = "on" if presolve else "off"
    return pulp.HiGHS(
        msg=False, timeLimit=seconds, threads=1, gapRel=0, gapAbs=0.5, random_seed=0, presolve=reduce
    )


def _cbc_path() -> str:
    """The CBC that PuLP 3 ships; ``PULP_CBC_CMD`` itself is deprecated."""
    return str(pulp.PULP_CBC_CMD.pulp_cbc_path)


def _outcome(problem: Any, columns: list[Any], seconds: float) -> Outcome:
    status, found = problem.status, problem.sol_status
    if status == pulp.LpStatusInfeasible:
        return Outcome("infeasible", seconds=seconds)
    bound = _bound(problem)
    values = _rounded(columns) if found in (pulp.LpSolutionOptimal, pulp.LpSolutionIntegerFeasible) else None
    if (status, found) == (pulp.LpStatusOptimal, pulp.LpSolutionOptimal):
        if values is None:
            return Outcome("undecided", None, bound, "the solver's values are not integral", seconds)
        return Outcome("optimal", values, bound, seconds=seconds)
    return Outcome("undecided", values, bound, "time limit", seconds)


def _bound(problem: Any) -> float | None:
    if problem.solverModel is None:
        return None  # CBC runs as a process and reports none
    return float(problem.solverModel.getInfo().mip_dual_bound)


def _rounded(columns: list[Any]) -> tuple[int, ...] | None:
    """Values as integers, or None if one is not nearly integral."""
    values = []
    for column in columns:
        value = column.varValue
        if value is None or (column.cat == pulp.LpInteger and abs(value - round(value)) > 1e-4):
            return None
        values.append(round(value))
    return tuple(values)
