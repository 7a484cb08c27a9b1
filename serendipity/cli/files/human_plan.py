"""The file of ``--human-plan``: what the human is going to do (see :mod:`serendipity.pddl.parsing.lists`)."""

from pathlib import Path

from serendipity.cli.files.reading import read_text
from serendipity.model import PlanError, Task
from serendipity.pddl.parsing.lists import actions_in


def checked_plan(path: Path | None, task: Task) -> tuple[str, ...] | None:
    """The names of the actions in a file, if there is one; waiting (``noop``) is not part of the plan.

    Raises:
        InputError: ``file:line`` and what was expected.
        PlanError: ``file:line`` and the first action that is wrong in the task, or the goal missed.
    """
    if path is None:
        return None
    found = actions_in(read_text(path), path, "human plan: ")
    kept = [(bare, line) for name, line in found if (bare := name.strip()).lower() not in ("", "noop")]
    names = tuple(name for name, _ in kept)
    try:
        task.plan_from_names(names)
    except PlanError as error:
        line = None if error.step is None else kept[error.step - 1][1]
        raise PlanError(error.message, path, line) from None
    return names
