"""``serendipity simulate``: what becomes of a plan that nobody told the human of."""

from typing import Annotated

import typer

import serendipity
from serendipity.cli.choices import choices
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.files.reading import Strict, broken_rule, read_result
from serendipity.cli.options import limits, naming, plan_options
from serendipity.cli.streams import output, progress
from serendipity.cli.streams.stderr import tell
from serendipity.model import InputError


def simulate(
    files: naming.FilesAndResult,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    human_model: Annotated[
        str,
        typer.Option(
            help="Sees everything, or only what is at the same place.", **choices("observant", "local")
        ),
    ] = "observant",
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    format: output.Format = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    strict: Strict = False,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Play a plan against a human who looks up and replans."""
    form = output.prepare(format, output_file, verbose)
    modules = ("serendipity.facade.simulation", "serendipity.facade.certify", "serendipity.cli.text.render")
    deadline = limits.begin(time_limit, memory_limit, *modules, *limits.PLANNING)
    named, answer, result = read_result(files, "simulate")
    task = naming.load(named, human, robot, agent, team, example, quiet=quiet, deadline=deadline)
    wrong = broken_rule(task, result, answer, deadline)
    if wrong is not None and strict:
        tell(f"Error: {wrong}")
        return ExitCode.REFUTED
    try:
        with progress.working("simulating", quiet=quiet), limits.during("playing the first epoch"):
            trace = serendipity.simulate(
                task, result, deadline=deadline, **plan_options.given(human_model=human_model)
            )
    except InputError as error:
        raise InputError(error.message, answer) from None
    if wrong is not None:
        output.warn((wrong,), quiet=quiet)
    if form == "json":
        output.write_answer(trace.to_json(), output_file)
    else:
        from serendipity.cli.text.render import rendered

        output.write_answer(rendered(trace.told()), output_file)
    return ExitCode.ANSWERED
