"""``serendipity show``: a result as a page that plays it, or as a still."""

from functools import partial
from pathlib import Path
from typing import Annotated, Final

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.files.reading import Strict, about, broken_rule
from serendipity.cli.options import naming
from serendipity.cli.streams import output, progress
from serendipity.cli.streams.stderr import tell
from serendipity.model import UsageError

SUFFIXES: Final = (".html", ".svg", ".png")


def show(
    *,
    task: Annotated[naming.TaskName, naming.AND_RESULT, naming.LENGTH],
    epoch: Annotated[
        int | None, option("--epoch N", "The epoch of a still; by default that of the first hand-over.")
    ] = None,
    scenario: Annotated[
        str | None,
        option(
            "--scenario NAME",
            "The scenario that is played (first); by default the most probable one.",
        ),
    ] = None,
    output_file: Annotated[
        Path | None, option("-o, --output FILE", "A page .html, or a still .svg or .png.")
    ] = None,
    strict: Strict = False,
) -> int:
    """Show a plan: a page that plays it, or a still. Who is where when, and what changes hands."""
    if output_file is None or output_file.suffix not in SUFFIXES:
        got = "none" if output_file is None else str(output_file)
        raise UsageError(f"-o: expected a file that ends in {', '.join(SUFFIXES)}, got {got}")
    if epoch is not None and output_file.suffix == ".html":
        raise UsageError("--epoch: is for stills (.svg, .png) only; a page shows every epoch")
    output.check_output(output_file)
    loaded, answer, result = task.with_result("show")
    wrong = broken_rule(loaded, result, answer)
    if wrong is not None and strict:
        tell(f"Error: {wrong}")
        return ExitCode.REFUTED
    from serendipity.pictures import build_scene, draw, other_scenes

    with about(answer), progress.working("drawing"):
        scene = build_scene(loaded, result, scenario)
        drawn = draw(scene, output_file.suffix, epoch, partial(other_scenes, loaded, result, scene))
    if wrong is not None:
        output.warn(wrong)
    output.write_answer(drawn, output_file)
    return ExitCode.ANSWERED
