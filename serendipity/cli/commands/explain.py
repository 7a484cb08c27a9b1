"""``serendipity explain``: why this help, or why none."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import serendipity
from serendipity.cli.exit_codes import OF_STATUS
from serendipity.cli.files.human_plan import read_human_plan
from serendipity.cli.files.reading import read_json
from serendipity.cli.options import limits, naming, plan_options
from serendipity.cli.streams import output, progress
from serendipity.model import Deadline, InputError, Result, Task

if TYPE_CHECKING:
    from serendipity.explanation import Explanation


def explain(
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="TASK [RESULT.json]",
            help="The task, named as for `plan`; then the result, or options.",
            show_default=False,
        ),
    ] = None,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    mode: plan_options.Mode = None,
    discount: plan_options.Discount = None,
    horizon: plan_options.Horizon = None,
    human_plan: plan_options.HumanPlan = None,
    window_weight: plan_options.WindowWeight = None,
    max_window: plan_options.MaxWindow = None,
    suffix: plan_options.Suffix = None,
    preservation: plan_options.Preservation = None,
    interference: plan_options.Interference = None,
    max_cost: plan_options.MaxCost = None,
    communication_weight: plan_options.CommunicationWeight = None,
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    format: output.Format = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Explain an answer. What changes, why then, from which discount on; or what stands in the way."""
    arguments = locals()
    form = output.prepare(format, output_file, verbose)
    modules = ("serendipity.explanation", "serendipity.facade.certify", "serendipity.cli.text.render")
    deadline = limits.begin(time_limit, memory_limit, *modules, *limits.PLANNING)
    named = list(files or ())
    answer = named.pop() if named and named[-1].suffix == ".json" else None
    task = naming.load(named, human, robot, agent, team, example, quiet=quiet, deadline=deadline)
    options = plan_options.among(arguments)
    if human_plan is not None:
        options["human_plan"] = read_human_plan(human_plan).checked(task)
    result = None if answer is None else _read(task, answer, deadline)
    with progress.counting("searches", quiet=quiet) as on_progress, limits.during("planning"):
        found = serendipity.explain(task, result, on_progress=on_progress, deadline=deadline, **options)
    output.write_answer(_shown(found, form), output_file)
    return OF_STATUS[found.answer.status]


def _read(task: Task, path: Path, deadline: Deadline) -> Result:
    """A result that the rules do not refute for the task."""
    result = Result.from_dict(read_json(path), path)
    try:
        certificate = serendipity.check(task, result, deadline=deadline)
    except InputError as error:
        raise InputError(error.message, path) from None
    wrong = certificate.refuted
    if wrong is not None:
        raise InputError(f"is no answer to this task: {wrong.claim}: {wrong.reason}", path)
    return result


def _shown(found: "Explanation", form: str) -> str:
    if form == "json":
        return found.to_json()
    from serendipity.cli.text.render import rendered

    return rendered(found.told())
