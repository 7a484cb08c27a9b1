"""``serendipity show``: a result as a page that plays it, or as a still."""

from pathlib import Path
from typing import Annotated, Final

import typer

from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.files.reading import Strict, broken_rule, read_result
from serendipity.cli.options import naming
from serendipity.cli.streams import output, progress
from serendipity.cli.streams.stderr import tell
from serendipity.model import InputError, UsageError

SUFFIXES: Final = (".html", ".svg", ".png")


def show(
    files: naming.FilesAndResult,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    epoch: Annotated[
        int | None,
        typer.Option(
            "--epoch", metavar="N", help="The epoch of a still; by default that of the first hand-over."
        ),
    ] = None,
    output_file: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="A page .html, or a still .svg or .png."),
    ] = None,
    strict: Strict = False,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Show a plan: a page that plays it, or a still. Who is where when, and what changes hands."""
    output.start_logging(verbose)
    if output_file is None or output_file.suffix not in SUFFIXES:
        got = "none" if output_file is None else str(output_file)
        raise UsageError(f"-o: expected a file that ends in {', '.join(SUFFIXES)}, got {got}")
    if epoch is not None and output_file.suffix == ".html":
        raise UsageError("--epoch: is for stills (.svg, .png) only; a page shows every epoch")
    output.check_output(output_file)
    named, answer, result = read_result(files, "show")
    task = naming.load(named, human, robot, agent, team, example, quiet=quiet)
    wrong = broken_rule(task, result, answer)
    if wrong is not None and strict:
        tell(f"Error: {wrong}")
        return ExitCode.REFUTED
    from serendipity.pictures import build_scene, draw

    try:
        with progress.working("drawing", quiet=quiet):
            drawn = draw(build_scene(task, result), output_file.suffix, epoch)
    except InputError as error:
        raise InputError(error.message, answer) from None
    if wrong is not None:
        output.warn((wrong,), quiet=quiet)
    output.write_answer(drawn, output_file)
    return ExitCode.ANSWERED
