"""The file of ``--human-plan``: what the human is going to do, one action a line.

``;`` and ``#`` start a comment, round brackets and a leading epoch (``3:``, ``3 -``) may be
there or not; or the file is a JSON list of action names.
"""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from serendipity.cli.files.reading import read_json, read_text
from serendipity.model import InputError, PlanError, Task

_EPOCH: Final = re.compile(r"^-?\s*\d+\s*[-:.]\s*")
_COMMENT: Final = re.compile(r"[;#].*")


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
    text = read_text(path)
    if text.lstrip().startswith("["):
        found = _from_json(path, text)
    else:
        found = [(_action(line, path, i), i) for i, line in enumerate(text.splitlines(), start=1)]
    kept = [(name, line) for name, line in found if name.lower() not in ("", "noop")]
    return HumanPlanFile(path, tuple(name for name, _ in kept), tuple(line for _, line in kept))


def _action(line: str, path: Path, number: int) -> str:
    """The action of a line; empty where there is none."""
    bare = _EPOCH.sub("", _COMMENT.sub("", line).strip(), count=1)
    if bare.startswith("(") and bare.endswith(")"):
        bare = bare[1:-1].strip()
    if "(" in bare or ")" in bare:
        message = f"human plan: expected one action, as 'move commx room13 hall8', got '{bare}'"
        raise InputError(message, path, number)
    return bare


def _from_json(path: Path, text: str) -> list[tuple[str, int]]:
    """The names of a JSON list, each with the line on which it stands."""
    names = read_json(path)
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise InputError("human plan: expected a JSON list of action names", path)
    found, at = [], 0
    for name in names:
        at = max(at, text.find(json.dumps(name), at))
        found.append((name.strip(), text.count("\n", 0, at) + 1))
        at += 1
    return found
