"""``serendipity recognise``: which goal the human has, from what was observed."""

from pathlib import Path
from typing import Annotated

import serendipity
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import limits, naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown


def recognise(
    *,
    task: naming.TaskName,
    goals: Annotated[Path, planning.GOALS],
    observed: planning.Observed = None,
    beta: planning.Beta = None,
    noise: planning.Noise = None,
    limited: limits.Limits,
    to: Annotated[output.Destination, output.ROWS_TOO],
) -> int:
    """Say how probable each goal is after what was done."""
    form = to.prepare(output.DATA)
    deadline = limited.begin("serendipity.recognition")
    loaded = task.load(deadline)
    given = planning.given(observed=observed, beta=beta, noise=noise)
    with progress.working("recognising"), limits.during("weighing the goals"):
        found = serendipity.recognise(loaded, goals, **given, deadline=deadline)
    output.write_answer(shown(found, form), to.output_file)
    return ExitCode.ANSWERED
