"""``serendipity check-proof``: does a proof file hold, and is it that of a result?"""

from pathlib import Path
from typing import Annotated

import typer

import serendipity
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.files.reading import read_result
from serendipity.cli.options import limits, naming
from serendipity.cli.streams import output, progress
from serendipity.model import InputError, Result, Task, UsageError

_Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="PROOF [TASK RESULT.json]",
        help="A file of `verify --proof`; then the task, named as for `plan`, and the result.",
        show_default=False,
    ),
]


def check_proof(
    files: _Files,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    format: output.Format = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Check a proof with integers only, without a solver. With a task and a result: that it is theirs."""
    form = output.prepare(format, output_file, verbose)
    deadline = limits.begin(time_limit, memory_limit, "serendipity.facade.proofs")
    proof, *others = files
    task: Task | None = None
    result: Result | None = None
    answer: Path | None = None
    if not others and any((human, robot, agent, team, example)):
        raise UsageError("check-proof: expected TASK and RESULT.json behind the proof, or neither")
    if others:
        named, answer, result = read_result(others, "check-proof")
        task = naming.load(named, human, robot, agent, team, example, quiet=quiet, deadline=deadline)
    try:
        with progress.working("checking", quiet=quiet), limits.during("checking the proof"):
            found = serendipity.check_proof(proof, task, result, deadline=deadline)
    except InputError as error:
        raise InputError(error.message, error.file or answer) from None
    if form == "json":
        output.write_answer(found.to_json(), output_file)
    else:
        from serendipity.cli.text.render import rendered

        output.write_answer(rendered(found.told()), output_file)
    return ExitCode.ANSWERED if found.accepted else ExitCode.REFUTED
