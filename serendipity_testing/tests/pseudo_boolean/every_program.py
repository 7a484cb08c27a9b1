"""The programs of many proofs beside those made a second time, solved by CP-SAT of OR-Tools.

    python -m serendipity_testing.tests.pseudo_boolean.every_program [FOLDER] [OPTIONS]

Calls are those of ``benchmarks.certificates``; it takes the extra ``bench``.  It counts programs with the
same optimum, those not made a second time, and those not solved within ``--solve-limit`` seconds, has a line
for each that differs or is not solved, and ends with exit code 1 where one differs.
"""

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from benchmarks.certificates import Asked, calls, planned, sources_of
from benchmarks.problems import Record, load, run
from serendipity.evaluation.measuring.figures import timed
from serendipity.evaluation.measuring.record import measured
from serendipity.model import Result
from serendipity_testing.pseudo_boolean.comparison import difference
from serendipity_testing.pseudo_boolean.opb import PseudoBooleanProblem
from serendipity_testing.pseudo_boolean.question import NotMadeError
from verify.certificate.certify import certify
from verify.proofs.book import ProofWriter

_SAME, _NOT_MADE, _NOT_SOLVED = "the same", "not made a second time", "not solved"


class _NotSolvedError(Exception):
    """CP-SAT had too little time."""


def main(
    folder: Annotated[Path | None, typer.Argument()] = None,
    human: str | None = None,
    suite: Path | None = None,
    stride: int = 1,
    modes: str = "serendipity,communication",
    discounts: str = "0,0.5,0.9",
    plan_limit: float | None = None,
    time_limit: float | None = None,
    solve_limit: float = 60,
    record: Record = None,
) -> None:
    """Plan, prove, compare, print counts."""
    tasks = sources_of(folder, human, "", suite, stride)
    asked = [(call, time_limit, solve_limit) for call in calls(tasks, modes, discounts, plan_limit)]
    counts, seconds = Counter[str](), 0.0
    for (call, *_), row in measured(asked, compared, record):
        for name, text in row["programs"]:
            counts[text if text in (_SAME, _NOT_MADE, _NOT_SOLVED) else "another"] += 1
            if text not in (_SAME, _NOT_MADE):
                typer.echo(f"{call.source} {call.mode} {call.discount}, {name}: {text}")
        seconds += row["seconds"]
    told = ", ".join(f"{count} {text}" for text, count in sorted(counts.items()))
    typer.echo(f"{sum(counts.values())} programs of {len(asked)} calls in {seconds:.0f} s: {told}")
    sys.exit(counts["another"] > 0)


def compared(asked: tuple[Asked, float | None, float]) -> dict[str, Any]:
    """Each program of a call's proof, with what the second one says; and seconds. No proof, no programs."""
    call, time_limit, solve_limit = asked
    nothing, answer = {"programs": [], "seconds": 0.0}, planned(call)
    if answer["status"] not in ("optimal", "infeasible"):
        return nothing
    task, result, writer = load(call.source), Result.from_dict(answer), ProofWriter()
    if certify(task, result, proof=writer, time_limit=time_limit, method="program").verdict != "proved":
        return nothing

    def work() -> Iterator[tuple[str, str]]:
        for entry in writer.programs:
            try:
                said = difference(task, result, entry, lambda problem: least(problem, solve_limit))
            except NotMadeError:
                yield entry["name"], _NOT_MADE
            except _NotSolvedError:
                yield entry["name"], _NOT_SOLVED
            else:
                yield entry["name"], said or _SAME

    programs, seconds = timed(lambda: [*work()])
    return {"programs": programs, "seconds": seconds}


def least(problem: PseudoBooleanProblem, limit: float) -> int | None:
    """The least objective of a problem; None where nothing satisfies it."""
    from ortools.sat.python import cp_model

    model, objective = cp_model.CpModel(), problem.objective or {}
    columns = {x: model.new_bool_var(x) for x in problem.variables}
    for terms, right in problem.constraints:
        model.add(sum(a * columns[x] for x, a in terms.items()) >= right)
    model.minimize(sum(a * columns[x] for x, a in objective.items()))
    solver = cp_model.CpSolver()
    solver.parameters.num_workers, solver.parameters.max_time_in_seconds = 1, limit
    status = solver.solve(model)
    if status == cp_model.INFEASIBLE:
        return None
    if status != cp_model.OPTIMAL:
        raise _NotSolvedError
    return sum(a * solver.value(columns[x]) for x, a in objective.items())


if __name__ == "__main__":
    run(main, __doc__)
