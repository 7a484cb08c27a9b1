"""``serendipity recognise``: which goal the human has, from what was observed."""

from pathlib import Path
from typing import Annotated

import typer

import serendipity
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import limits, naming, plan_options
from serendipity.cli.streams import output, progress
from serendipity.cli.text import goals as goal_options
from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import written


def recognise(
    *,
    files: naming.Files = None,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    goals: Annotated[
        Path,
        typer.Option(
            "--goals",
            metavar="FILE",
            help="Goals that the human may have: JSON, or 'prior: fact, fact' on each line.",
        ),
    ],
    observed: goal_options.Observed = None,
    beta: goal_options.Beta = None,
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    format: output.DataFormat = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Say how probable each goal is after what was done."""
    form = output.prepare(format, output_file, verbose, output.DATA)
    deadline = limits.begin(time_limit, memory_limit, "serendipity.recognition")
    task = naming.load(files, human, robot, agent, team, example, quiet=quiet, deadline=deadline)
    given = plan_options.given(observed=observed, beta=beta)
    with progress.working("recognising", quiet=quiet), limits.during("weighing the goals"):
        found = serendipity.recognise(task, goals, **given, deadline=deadline)
    if form == "json":
        output.write_answer(found.to_json(), output_file)
    elif form in ROWS:
        output.write_answer(written(found.table(), form), output_file)
    else:
        from serendipity.cli.text.render import rendered

        output.write_answer(rendered(found.told()), output_file)
    return ExitCode.ANSWERED
