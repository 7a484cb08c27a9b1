"""HiGHS on a program of ours: what is quickly solved in this process, all else in one that can be killed.

HiGHS looks at its time limit between the steps of its work, and on large programs a single step
has taken twenty seconds.  While it works here, nobody looks at the memory, at ``cancelled`` or at Ctrl-C.
"""

import json
import pickle
import sys
from array import array
from math import inf
from tempfile import TemporaryFile
from time import time
from typing import Final

from serendipity.model import Deadline, LimitReachedError
from verify.limits import limits
from verify.solvers import worker
from verify.solvers.model import Model, SolverAnswer
from verify.solvers.process import run, seconds_for

_UNENDING: Final = 1e9


def minimise(model: Model, deadline: Deadline) -> SolverAnswer:
    """Minimise with one thread and a fixed seed."""
    program = tables(model, deadline)
    if len(model.index) <= limits().solved_here:
        left, seconds = deadline.left(), limits().solver_seconds
        short = left is not None and left < 4 * seconds  # too short for trying both
        end = _end(deadline) if short else time() + seconds
        # without a presolve there is nothing to trust but the solver
        answer = SolverAnswer(**worker.minimise(program, end, presolve=False))
        if short or answer.status != "time-limit":
            return answer
    return _apart(program, deadline, presolve=model.presolve)


def _apart(program: worker.ProgramArrays, deadline: Deadline, *, presolve: bool) -> SolverAnswer:
    """HiGHS in a process; where it is killed, the last bound that it has told is known."""
    with TemporaryFile() as question, TemporaryFile() as said:
        for table in program:
            deadline.check()
            pickle.dump(table, question, pickle.HIGHEST_PROTOCOL)
        question.seek(0)
        command = [sys.executable, "-P", worker.__file__, repr(_end(deadline)), str(presolve)]
        try:
            code = run(command, deadline, stdin=question, stdout=said)
            answer = SolverAnswer(f"HiGHS ended with exit status {code}")
        except LimitReachedError as limit:
            answer = SolverAnswer(limit.reason)
        said.seek(0)
        for line in said:
            if line.endswith(b"\n"):
                answer = answer._replace(**json.loads(line))
        return answer


def _end(deadline: Deadline) -> float:
    """When HiGHS is to stop by itself, in seconds of the system's clock."""
    seconds = seconds_for(deadline)
    return time() + (_UNENDING if seconds is None else seconds)


def tables(model: Model, deadline: Deadline) -> worker.ProgramArrays:
    """A program as HiGHS takes it."""
    columns = range(len(model.upper))
    start, row_lower, row_upper = array("i", [0]), array("d"), array("d")
    for end, (sense, right) in zip(deadline.each(model.ends), model.heads, strict=True):
        start.append(end)
        row_lower.append(-inf if sense == "<=" else right)
        row_upper.append(inf if sense == ">=" else right)
    return worker.ProgramArrays(
        array("d", (model.objective.get(x, 0) for x in deadline.each(columns))),
        array("d", deadline.each(model.lower)),
        array("d", deadline.each(model.upper)),
        array("b", deadline.each(model.integral)),
        row_lower,
        row_upper,
        start,
        model.index,
        array("d", deadline.each(model.coefficients)),
    )
