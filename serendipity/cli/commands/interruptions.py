"""``serendipity interruptions``: in which windows the human could be helped, and by how much."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

import serendipity
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.files.human_plan import read_human_plan
from serendipity.cli.options import limits, naming, plan_options
from serendipity.cli.streams import output, progress
from serendipity.model import UsageError
from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import written

_PICTURES: Final = (".svg", ".png")

_WRITE_SHARE: Final = {"json": 0.4} | dict.fromkeys(("text", *ROWS), 0.05)
"""What of the time limit is kept for writing: thousands of windows, in JSON each with its plan."""

if TYPE_CHECKING:
    from serendipity.facade.interruptibility import InterruptionReport


def interruptions(
    files: naming.Files = None,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    discount: plan_options.Discount = None,
    horizon: plan_options.Horizon = None,
    human_plan: plan_options.HumanPlan = None,
    suffix: plan_options.Suffix = None,
    preservation: plan_options.Preservation = None,
    interference: plan_options.Interference = None,
    heat_map: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Also draw savings by start and end (.svg, .png).")
    ] = None,
    every: Annotated[
        bool, typer.Option("--all", help="Every window, also where a smaller one within saves as much.")
    ] = False,
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    format: output.DataFormat = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Say in which windows help would pay. What the human, or the team, could save, and what would change."""
    arguments = locals()
    form = output.prepare(format, output_file, verbose, output.DATA)
    output.check_output(heat_map, "--heat-map")
    if heat_map is not None and heat_map.suffix not in _PICTURES:
        raise UsageError(f"--heat-map: expected a file that ends in {', '.join(_PICTURES)}, got {heat_map}")
    modules = ("serendipity.facade.interruptibility", *limits.PLANNING)
    deadline = limits.begin(time_limit, memory_limit, *modules)
    task = naming.load(files, human, robot, agent, team, example, quiet=quiet, deadline=deadline)
    options = plan_options.among(arguments)
    if human_plan is not None:
        options["human_plan"] = read_human_plan(human_plan).checked(task)
    with progress.counting("searches", quiet=quiet) as on_progress, limits.during("planning"):
        early = deadline.sooner(_WRITE_SHARE[form])
        report = serendipity.interruptions(task, on_progress=on_progress, deadline=early, **options)
    answers = [output.Answer(_shown(report, form, every=every), output_file)]
    if heat_map is not None:
        from serendipity.facade.interruptibility import drawn

        answers.append(output.Answer(drawn(report, heat_map.suffix), heat_map, "--heat-map"))
    output.write_answers(answers)
    return _code(report)


def _code(report: "InterruptionReport") -> ExitCode:
    if report.human_plan is None:
        return ExitCode.INFEASIBLE
    return ExitCode.ANSWERED if report.complete or report.windows else ExitCode.UNDECIDED


def _shown(report: "InterruptionReport", form: str, *, every: bool) -> str | bytes:
    if form == "json":
        return report.to_json()
    if form in ROWS:
        return written(report.table(), form)
    from serendipity.cli.text.render import rendered

    return rendered(report.told(every=every))
