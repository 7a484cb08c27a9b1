"""``serendipity solve``: the integer program as a planner of its own."""

from typing import Annotated, Final

import serendipity
from serendipity.cli.exit_codes import OF_STATUS, ExitCode
from serendipity.cli.options import limits, naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.text.answers import plan_report

_CHECK_SHARE: Final = 0.05
"""What the check of an answer may add to the time limit: a share of it."""


def solve(
    *,
    task: naming.TaskName,
    options: Annotated[planning.Planning, planning.PROGRAMS],
    limited: limits.Limits,
    solver: planning.Solver = "highs",
    encoding: planning.Encoding = "automata",
    to: output.Destination,
) -> int:
    """Answer as `plan` does, by integer programming alone. It is slower, and independent of the search."""
    from serendipity.facade.call import options_from
    from verify.calls.solve import solve as by_program

    form = to.prepare()
    deadline = limited.begin("serendipity.facade.certify", *limits.CHECKING)
    loaded = task.load(deadline)
    asked = options_from(options.given | limited.given)
    given = options.plan_of(loaded)
    with progress.working("solving"):
        result = by_program(
            loaded, asked, human_plan=given, encoding=encoding, solver=solver, deadline=deadline
        )
    certificate = serendipity.check(loaded, result, deadline=deadline.sooner(-_CHECK_SHARE))
    answer = result.to_json() if form == "json" else plan_report(loaded, result, certificate)
    output.write_answer(answer, to.output_file)
    return ExitCode.REFUTED if certificate.verdict == "refuted" else OF_STATUS[result.status]
