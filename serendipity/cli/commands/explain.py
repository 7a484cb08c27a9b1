"""``serendipity explain``: why this help, or why none."""

from pathlib import Path
from typing import Annotated, Final

import serendipity
from serendipity.cli.exit_codes import OF_STATUS
from serendipity.cli.files.reading import about, read_json
from serendipity.cli.options import limits, naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown
from serendipity.model import Deadline, Result, Task

_FILES: Final = naming.files(
    "TASK [RESULT.json]", "The task, named as for `plan`; then the result, or options.", required=False
)


def explain(
    *,
    task: Annotated[naming.TaskName, _FILES],
    options: Annotated[planning.Planning, planning.EXPLAINED],
    limited: limits.Limits,
    to: output.Destination,
) -> int:
    """Explain an answer. What changes, why then, from which discount on; or what stands in the way."""
    form = to.prepare()
    modules = ("serendipity.explanation", "serendipity.facade.certify", "serendipity.cli.text.render")
    deadline = limited.begin(*modules, *limits.PLANNING)
    named = list(task.files or ())
    answer = named.pop() if named and named[-1].suffix == ".json" else None
    loaded = task.but(files=named).load(deadline)
    given = options.plan_of(loaded)
    result = None if answer is None else _read(loaded, answer, deadline)
    if result is not None and len(result.goals or ()) > 1 and not options.given:
        with limits.during("planning"):
            told = serendipity.explain_policy(loaded, result, deadline=deadline)
        output.write_answer(shown(told, form), to.output_file)
        return OF_STATUS[result.status]
    with progress.counting("searches") as on_progress, limits.during("planning"):
        found = serendipity.explain(
            loaded, result, human_plan=given, on_progress=on_progress, deadline=deadline, **options.given
        )
    output.write_answer(shown(found, form), to.output_file)
    return OF_STATUS[found.answer.status]


def _read(task: Task, path: Path, deadline: Deadline) -> Result:
    """A result that the rules do not refute for the task."""
    result = Result.from_dict(read_json(path), path)
    from serendipity.facade.certify import require_answer

    with about(path):
        require_answer(task, result, path, deadline)
    return result
