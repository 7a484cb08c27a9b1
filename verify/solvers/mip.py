"""Integer programs and the solvers behind them: what a solver says, and how far it is believed.

* An optimum is one that the solver calls so; what a limit has stopped proves nothing but its bound;
* ``infeasible`` is a proof that nothing satisfies the rows, since every column is bounded;
* HiGHS 1.14 to 1.16 are not asked for: the presolve of 1.14 removes solutions, so that feasible programs
  are called infeasible and dear solutions optimal (ERGO-Code/HiGHS #2961 and #3090); 1.15 does not load
  beside ortools; 1.16.0 prints to stdout, and without the rules that 1.13 has to do without it calls 4 of
  10,000 programs of calls infeasible that are not.  A model says whether a presolve is worth it at all;
* numbers of a program are integers of 10^7 at most (``limits().coefficient``).  A tolerance may let
  something pass that the rows forbid, which is checked in integers; and a bound may be too high by a dual
  tolerance of 1e-7 for a column in use, and by what doubles lose of 10^7, a billionth: far from the half
  unit that gaps and rounding leave.  Questions with larger numbers are asked with smaller ones whose sums
  have the same order (``verify.base.small_numbers``), or not at all;
* values are rounded; whoever asked re-checks the plan they stand for against the task.

A solver keeps a time limit only roughly.  CBC and, for more than a moment, HiGHS run as processes, which
are killed where the deadline comes.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Final

from serendipity.model import Deadline, LimitReachedError, UsageError
from serendipity.model.errors import LIMITS, limit_reason
from verify.limits import limits
from verify.solvers import cbc, highs
from verify.solvers.model import Model, ModelRow, SolverAnswer, Terms, largest

SOLVERS: Final = ("highs", "cbc")
"""Names of the solvers; the first is the default, the other the cross-check."""

_LOADING: Final = 0.2
"""Seconds for loading HiGHS or PuLP, which nothing interrupts."""

_BYTES: Final = 300
"""Memory of a solver for each coefficient, copies included."""

BYTES_A_TERM: Final = 16 + _BYTES
"""Memory for each coefficient of a program, from its first row to its solution."""

_CALLS: Final = {"highs": ("highspy", highs.minimise), "cbc": ("pulp", cbc.minimise)}
"""The module that each solver loads, and its call."""


@dataclass(frozen=True, slots=True)
class SolverOutcome:
    """What a solver found out.

    Attributes:
        status: ``optimal`` (``values`` is proved best), ``infeasible`` (proved) or
            ``undecided`` (``values`` may hold a solution, of which nothing is proved).
        values: one integer per column, or None.
        bound: proved lower bound on the objective, or None.
        reason: why it is undecided.
    """

    status: str
    values: tuple[int, ...] | None = None
    bound: float | None = None
    reason: str = ""


def solver_version(solver: str) -> str:
    """Name and version for certificates: ``HiGHS 1.13.1``."""
    if solver == "highs":
        return f"HiGHS {version('highspy')}"
    return f"CBC (PuLP {version('pulp')})"


def optimise(model: Model, *, solver: str = "highs", deadline: Deadline | None = None) -> SolverOutcome:
    """Minimise the model's objective, with one thread and a fixed seed.

    Args:
        deadline: when to stop; an outcome that it stops is ``undecided``.
    """
    if solver not in SOLVERS:
        raise UsageError(f"solver: expected one of {', '.join(SOLVERS)}, got {solver!r}")
    try:
        return _optimise(model, solver, deadline or Deadline())
    except LIMITS as limit:
        return SolverOutcome("undecided", reason=_reason(limit_reason(limit), model))
    except OSError as error:  # no process, no room for a temporary file
        return SolverOutcome("undecided", reason=f"the solver could not be run: {error.strerror or error}")


def _optimise(model: Model, solver: str, deadline: Deadline) -> SolverOutcome:
    if not model.upper:
        holds = all(_true(head) for head in deadline.each(model.heads))
        return SolverOutcome("optimal", (), 0.0) if holds else SolverOutcome("infeasible")
    if largest(model, deadline) > limits().coefficient:
        return SolverOutcome("undecided", reason="costs need more digits than a solver's tolerance leaves")
    deadline.check()
    deadline.require(_BYTES * len(model.index))
    module, minimise = _CALLS[solver]
    left = deadline.left()
    if module not in sys.modules and left is not None and left < _LOADING:
        raise LimitReachedError("time-limit")
    return _outcome(minimise(model, deadline), model, deadline)


def _true(head: tuple[str, int]) -> bool:
    """Whether a row without columns holds."""
    sense, right = head
    return {"<=": right >= 0, ">=": right <= 0, "==": right == 0}[sense]


def _outcome(answer: SolverAnswer, model: Model, deadline: Deadline) -> SolverOutcome:
    if answer.status == "infeasible":
        return SolverOutcome("infeasible")
    try:
        values = None if answer.values is None else _rounded(answer.values, model.integral, deadline)
    except LimitReachedError as limit:
        return SolverOutcome("undecided", None, answer.bound, _reason(limit.reason, model))
    if answer.status != "optimal":
        return SolverOutcome("undecided", values, answer.bound, _reason(answer.status, model))
    if values is None:
        return SolverOutcome("undecided", None, answer.bound, "the solver's values are not integral")
    return SolverOutcome("optimal", values, answer.bound)


def _reason(status: str, model: Model) -> str:
    """A limit, or the solver's own words, in words for people."""
    size = f"solving a program of {len(model.upper):,} columns and {len(model.ends):,} rows"
    return str(LimitReachedError(status, size))


def _rounded(values: Sequence[float], integral: Sequence[bool], deadline: Deadline) -> tuple[int, ...] | None:
    """Values as integers, or None if one is not nearly integral."""
    rounded = []
    for value, whole in zip(deadline.each(values), integral, strict=True):
        rounded.append(round(value))
        if whole and abs(value - rounded[-1]) > 1e-4:
            return None
    return tuple(rounded)


__all__ = ["SOLVERS", "Model", "ModelRow", "SolverOutcome", "Terms", "optimise", "solver_version"]
