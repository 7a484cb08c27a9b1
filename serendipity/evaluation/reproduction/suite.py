"""The tasks of a folder, in natural order, each with a fingerprint of what its files say."""

import hashlib
import re
from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from serendipity.model import InputError, UsageError
from serendipity.pictures.map.names import natural

_NUMBERED = re.compile(r"test(\d+)")


@dataclass(frozen=True, slots=True)
class TaskFolder:
    """A task of a suite: N for ``testN`` if no other is N; and a fingerprint that changes with its files."""

    test: str
    path: Path
    fingerprint: str


def find_tasks(folder: Path) -> tuple[TaskFolder, ...]:
    """The tasks in a folder: its subfolders in which agents have theirs.

    Raises:
        InputError: there is no such folder, or no task in it.
        UsageError: the folder is a task itself.
    """
    try:
        is_folder = folder.is_dir()
    except OSError as error:  # a name that is too long
        raise InputError(f"can't be read: {error.strerror}", folder) from None
    if not is_folder:
        raise InputError("expected a folder of tasks", folder)
    if _is_task(folder):
        raise UsageError(f"{folder} is a single task: expected a folder of tasks; try `serendipity plan`")
    found = [path for path in folder.iterdir() if _is_task(path)]
    if not found:
        raise InputError("no task in this folder: expected testN/AGENT/domain.pddl", folder)
    names = {path.name for path in found}
    tasks = (TaskFolder(_name(path, names), path, _fingerprint(path)) for path in found)
    return tuple(sorted(tasks, key=lambda task: natural(task.test)))


def _is_task(path: Path) -> bool:
    return path.is_dir() and next(path.glob("*/domain.pddl"), None) is not None


def _name(path: Path, names: Collection[str]) -> str:
    numbered = _NUMBERED.fullmatch(path.name)
    return numbered[1] if numbered and numbered[1] not in names else path.name


def _fingerprint(path: Path) -> str:
    digest = hashlib.sha256()
    for file in sorted(path.glob("*/*.pddl")):
        digest.update(f"{file.parent.name}/{file.name}\0".encode())
        with suppress(OSError):  # who reads it says what is wrong with it
            digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:16]
