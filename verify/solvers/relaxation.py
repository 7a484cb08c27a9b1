"""HiGHS on the linear relaxation of a program, again and again with other bounds of columns."""

from collections.abc import Mapping
from typing import Any, Final, NamedTuple

from serendipity.model import Deadline, LimitReachedError
from verify.solvers import worker
from verify.solvers.highs import tables
from verify.solvers.model import Model

_SETTINGS: Final = {
    "output_flag": False,
    "presolve": "off",
    "threads": 1,
    "random_seed": 0,
    "solver": "simplex",
}
"""Without a presolve there is a dual solution, or a ray, for the rows as they are."""


class Relaxed(NamedTuple):
    """What HiGHS says of a relaxation, in floating point.

    Attributes:
        values: of the columns at the optimum; None where nothing satisfies the rows.
        duals: of the rows: what the optimum gains for each unit of the right-hand side, or a ray that
            shows that nothing satisfies the rows.
    """

    values: list[float] | None
    objective: float
    duals: list[float]


class Relaxation:
    """The linear relaxation of a program; what changes between two questions is the bounds of columns.

    Args:
        deadline: HiGHS looks at the time between its steps.
    """

    def __init__(self, model: Model, deadline: Deadline) -> None:
        import highspy

        self._model = model
        self._deadline = deadline
        self._changed: dict[int, tuple[int, int]] = {}
        self._solver: Any = highspy.Highs()
        for name, value in _SETTINGS.items():
            self._solver.setOptionValue(name, value)
        problem = worker.problem(tables(model, deadline))
        problem.integrality_ = []
        self._solver.passModel(problem)

    def solve(self, bounds: Mapping[int, tuple[int, int]]) -> Relaxed:
        """The relaxation with other bounds of some columns.

        Raises:
            LimitReachedError: the deadline came first, or HiGHS gave no answer.
        """
        self._deadline.check()
        if not self._model.upper:
            return Relaxed([], 0.0, [0.0] * len(self._model.heads))
        self._restrict(bounds)
        left = self._deadline.left()
        if left is not None:
            self._solver.setOptionValue("time_limit", self._solver.getRunTime() + left)
        self._solver.run()
        status = self._solver.getModelStatus().name
        if status == "kOptimal":
            solution = self._solver.getSolution()
            objective = self._solver.getInfo().objective_function_value
            return Relaxed(list(solution.col_value), objective, list(solution.row_dual))
        if status == "kInfeasible":
            _, known, ray = self._solver.getDualRay()
            return Relaxed(None, 0.0, list(ray) if known else [])
        self._deadline.check()
        raise LimitReachedError("time-limit" if status == "kTimeLimit" else f"HiGHS: {status}")

    def _restrict(self, bounds: Mapping[int, tuple[int, int]]) -> None:
        for x in self._changed.keys() | bounds.keys():
            low, high = bounds.get(x, (self._model.lower[x], self._model.upper[x]))
            if (low, high) != self._changed.get(x):
                self._solver.changeColBounds(x, low, high)
        self._changed = dict(bounds)
