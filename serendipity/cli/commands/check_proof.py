"""``serendipity check-proof``: does a proof file hold, and is it that of a result?"""

from pathlib import Path
from typing import Annotated, Final

import serendipity
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.files.reading import about
from serendipity.cli.options import limits, naming
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown
from serendipity.model import Result, Task, UsageError

_FILES: Final = naming.files(
    "PROOF [TASK RESULT.json]",
    "A file of `verify --proof`; then the task, named as for `plan`, and the result.",
)


def check_proof(
    *, task: Annotated[naming.TaskName, _FILES], limited: limits.Limits, to: output.Destination
) -> int:
    """Check a proof with integers only, without a solver. With a task and a result: that it is theirs."""
    form = to.prepare()
    deadline = limited.begin("serendipity.facade.proofs")
    proof, *others = task.files or []
    task = task.but(files=others)
    loaded: Task | None = None
    result: Result | None = None
    answer: Path | None = None
    if others:
        loaded, answer, result = task.with_result("check-proof", deadline)
    elif any((task.human, task.robot, task.agent, task.team, task.example)):
        raise UsageError("check-proof: expected TASK and RESULT.json behind the proof, or neither")
    with about(answer), progress.working("checking"), limits.during("checking the proof"):
        found = serendipity.check_proof(proof, loaded, result, deadline=deadline)
    output.write_answer(shown(found, form), to.output_file)
    return ExitCode.ANSWERED if found.accepted else ExitCode.REFUTED
