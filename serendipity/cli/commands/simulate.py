"""``serendipity simulate``: what becomes of a plan that nobody told the human of."""

from typing import Annotated

import serendipity
from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.files.reading import Strict, about, broken_rule
from serendipity.cli.options import limits, naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.streams.stderr import tell
from serendipity.cli.text.render import shown


def simulate(
    *,
    task: Annotated[naming.TaskName, naming.AND_RESULT],
    human_model: Annotated[
        str, option("--human-model observant|local", "Sees everything, or only what is at the same place.")
    ] = "observant",
    limited: limits.Limits,
    to: output.Destination,
    strict: Strict = False,
) -> int:
    """Play a plan against a human who looks up and replans."""
    form = to.prepare()
    modules = ("serendipity.facade.simulation", "serendipity.facade.certify", "serendipity.cli.text.render")
    deadline = limited.begin(*modules, *limits.PLANNING)
    loaded, answer, result = task.with_result("simulate", deadline)
    wrong = broken_rule(loaded, result, answer, deadline)
    if wrong is not None and strict:
        tell(f"Error: {wrong}")
        return ExitCode.REFUTED
    asked = planning.given(human_model=human_model)
    with about(answer), progress.working("simulating"), limits.during("playing the first epoch"):
        trace = serendipity.simulate(loaded, result, deadline=deadline, **asked)
    if wrong is not None:
        output.warn(wrong)
    output.write_answer(shown(trace, form), to.output_file)
    return ExitCode.ANSWERED
