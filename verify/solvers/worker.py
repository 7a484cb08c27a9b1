"""HiGHS on one program: called by ``verify.solvers.highs``, or run as a process that can be killed.

As a process it is this file alone, so it imports nothing of ours.
"""

import json
import os
import pickle
import sys
from array import array
from threading import Thread
from time import sleep, time
from typing import IO, Any, Final, NamedTuple

Answer = dict[str, Any]
"""The fields of ``verify.solvers.model.Answer``."""

_STATUS: Final = {
    "kOptimal": "optimal",
    "kInfeasible": "infeasible",
    "kUnboundedOrInfeasible": "infeasible",  # every column is bounded
    "kTimeLimit": "time-limit",
    "kMemoryLimit": "memory-limit",
}


class ProgramArrays(NamedTuple):
    """A program; the terms of its rows are stored one after the other.

    Attributes:
        cost: coefficient in the objective, by column.
        lower: least value, by column.
        upper: largest value, by column.
        integral: 1 if only whole values count, by column.
        row_lower: least value, by row.
        row_upper: largest value, by row.
        row_start: index of the first term, by row; one more entry says where the last row ends.
        row_index: column, by term.
        row_value: coefficient, by term.
    """

    cost: "array[float]"
    lower: "array[float]"
    upper: "array[float]"
    integral: "array[int]"
    row_lower: "array[float]"
    row_upper: "array[float]"
    row_start: "array[int]"
    row_index: "array[int]"
    row_value: "array[float]"


_MISTAKEN: Final = 1 << 12 | 1 << 13 | 1 << 16
"""Rules of HiGHS's presolve that lose solutions together (1.13.1): aggregator, parallel rows, enumeration."""


def minimise(program: ProgramArrays, end: float, *, presolve: bool, news: IO[str] | None = None) -> Answer:
    """Minimise with one thread and a fixed seed; the objective is integral, so a gap below one half is none.

    Args:
        end: when HiGHS is to stop, in seconds of the system's clock; it may overrun it.
        presolve: whether HiGHS reduces the program first.
        news: where every better bound is written down at once, a JSON object a line.
    """
    import highspy

    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    solver.passModel(problem(program))
    options = {
        "time_limit": max(end - time(), 0.0),
        "threads": 1,
        "mip_rel_gap": 0.0,
        "mip_abs_gap": 0.5,
        "random_seed": 0,
        "presolve": "on" if presolve else "off",
        "presolve_rule_off": _MISTAKEN,
    }
    for name, value in options.items():
        solver.setOptionValue(name, value)
    if news is not None:
        solver.cbMipInterrupt += _Reporter(news)
    solver.run()
    return _answer(solver)


def problem(program: ProgramArrays) -> Any:
    """A program as an object of HiGHS's."""
    import highspy
    import numpy as np

    made, given = highspy.HighsLp(), ProgramArrays(*map(np.asarray, program))  # type: ignore[arg-type]
    made.num_col_, made.num_row_ = len(given.cost), len(given.row_lower)
    made.col_cost_, made.col_lower_, made.col_upper_ = given.cost, given.lower, given.upper
    made.row_lower_, made.row_upper_ = given.row_lower, given.row_upper
    kinds = highspy.HighsVarType.kContinuous, highspy.HighsVarType.kInteger
    made.integrality_ = [kinds[whole] for whole in program.integral]
    matrix = made.a_matrix_
    matrix.format_ = highspy.MatrixFormat.kRowwise
    matrix.start_, matrix.index_, matrix.value_ = given.row_start, given.row_index, given.row_value
    return made


def _answer(solver: Any) -> Answer:
    import highspy

    status, info = solver.getModelStatus().name, solver.getInfo()
    has_values = info.primal_solution_status == int(highspy.SolutionStatus.kSolutionStatusFeasible)
    return {
        "status": _STATUS.get(status, f"HiGHS: {status}"),
        "values": list(solver.getSolution().col_value) if has_values else None,
        "bound": _finite(info.mip_dual_bound),
    }


def _finite(bound: float) -> float | None:
    return bound if abs(bound) < 1e15 else None


class _Reporter:
    """Writes the bound down whenever HiGHS asks whether to go on, if it has risen."""

    def __init__(self, news: IO[str]) -> None:
        self._news = news
        self._known: float | None = None

    def __call__(self, event: Any) -> None:
        bound = _finite(event.data_out.mip_dual_bound)
        if bound is not None and (self._known is None or bound > self._known):
            self._known = bound
            write({"bound": bound}, self._news)


def write(line: Answer, file: IO[str]) -> None:
    """Write an object down as a line."""
    file.write(json.dumps(line) + "\n")
    file.flush()


def _end_with_parent() -> None:
    """End this process soon after the one that waits for it was killed."""
    parent = os.getppid()
    while os.getppid() == parent:
        sleep(1)
    os._exit(1)


def main() -> None:
    """``worker.py END PRESOLVE``: tables from stdin, answers to stdout, the last one counts."""
    Thread(target=_end_with_parent, daemon=True).start()
    end, presolve = sys.argv[1:]
    try:
        program = ProgramArrays(*(pickle.load(sys.stdin.buffer) for _ in ProgramArrays._fields))
        answer = minimise(program, float(end), presolve=presolve == "True", news=sys.stdout)
        write(answer, sys.stdout)
    except MemoryError:
        write({"status": "memory-limit"}, sys.stdout)


if __name__ == "__main__":
    main()
