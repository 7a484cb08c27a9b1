"""``serendipity interruptions``: in which windows the human could be helped, and by how much."""

from pathlib import Path
from typing import Annotated, Final

import serendipity
from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import limits, naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown
from serendipity.writing.rows import FORMATS as ROWS

_WRITE_SHARE: Final = {"json": 0.4} | dict.fromkeys(("text", *ROWS), 0.05)
"""What of the time limit is kept for writing: thousands of windows, in JSON each with its plan."""


def interruptions(
    *,
    task: naming.TaskName,
    options: Annotated[planning.Planning, planning.WINDOWS],
    heat_map: Annotated[
        Path | None, option("--heat-map FILE", "Also draw savings by start and end (.svg, .png).")
    ] = None,
    every: Annotated[
        bool, option("--all", "Every window, also where a smaller one within saves as much.")
    ] = False,
    limited: limits.Limits,
    to: Annotated[output.Destination, output.ROWS_TOO],
) -> int:
    """Say in which windows help would pay. What the human, or the team, could save, and what would change."""
    form = to.prepare(output.DATA)
    output.check_picture(heat_map, "--heat-map", to.output_file)
    modules = ("serendipity.facade.interruptibility", *limits.PLANNING)
    deadline = limited.begin(*modules)
    loaded = task.load(deadline)
    given = options.plan_of(loaded)
    with progress.counting("searches") as on_progress, limits.during("planning"):
        early = deadline.sooner(_WRITE_SHARE[form])
        report = serendipity.interruptions(
            loaded, human_plan=given, on_progress=on_progress, deadline=early, **options.given
        )
    answers = [output.Answer(shown(report, form, every=every), to.output_file)]
    if heat_map is not None:
        from serendipity.facade.interruptibility import drawn

        answers.append(output.Answer(drawn(report, heat_map.suffix), heat_map, "--heat-map"))
    output.write_answers(answers)
    if report.human_plan is None:
        return ExitCode.INFEASIBLE
    return ExitCode.ANSWERED if report.complete or report.windows else ExitCode.UNDECIDED
