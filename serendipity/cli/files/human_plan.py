"""The file of ``--human-plan``: what the human is going to do (see :mod:`serendipity.pddl.parsing.lists`)."""

from dataclasses import dataclass
from pathlib import Path

from serendipity.cli.files.reading import read_text
from serendipity.model import PlanError, Task
from serendipity.pddl.parsing.lists import actions_in


@dataclass(frozen=True, slots=True)
class HumanPlanFile:
    """Action names, and the line of the file that each comes from."""

    path: Path
    names: tuple[str, ...]
    lines: tuple[int, ...]

    def checked(self, task: Task) -> tuple[str, ...]:
        """The names of the actions, if they are a plan of the human in the task.

        Raises:
            PlanError: ``file:line`` and the first action that is wrong, or the goal missed.
        """
        try:
            task.plan_from_names(self.names)
        except PlanError as error:
            line = None if error.step is None else self.lines[error.step - 1]
            raise PlanError(error.message, self.path, line) from None
        return self.names


def read_human_plan(path: Path) -> HumanPlanFile:
    """Read a human plan; waiting (``noop``) is not part of it.

    Raises:
        InputError: ``file:line`` and what was expected.
    """
    found = actions_in(read_text(path), path, "human plan: ")
    kept = [(bare, line) for name, line in found if (bare := name.strip()).lower() not in ("", "noop")]
    return HumanPlanFile(path, tuple(name for name, _ in kept), tuple(line for _, line in kept))


def checked_plan(path: Path | None, task: Task) -> tuple[str, ...] | None:
    """The plan of the human in a file, if there is one; errors as of reading and checking it."""
    return None if path is None else read_human_plan(path).checked(task)
