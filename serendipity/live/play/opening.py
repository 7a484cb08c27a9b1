"""What the command line asks for, as something that pages can be opened on."""

from datetime import datetime
from itertools import count
from pathlib import Path
from typing import Any

from serendipity.live.play.labels import labels_for
from serendipity.live.play.setting import Setting
from serendipity.live.play.table import Table
from serendipity.model import Task, UsageError


def open_table(
    name: str, task: Task, file: Path | None = None, labels: Path | None = None, **how: Any
) -> Table:
    """Rounds of one task.

    Args:
        name: of the task, for people.
        task: the task.
        file: where every event is written down when it happens; None: nowhere.
        labels: words for its domain; None: those that are shipped, if it is one of ours.
        **how: the other fields of :class:`.setting.Setting`.

    Raises:
        SerendipityError: the human can't reach the goal alone, or ``goals`` are wrong.
        UsageError: the file can't be written.
        InputError: a file is wrong.
    """
    return Table(Setting(name, task, labels=labels_for(task, labels), **how), file)


def record_in(place: Path) -> Path:
    """Where what is played from now on is recorded.

    Args:
        place: a file that is there, to go on with; or a folder, which is made, for a new file named after
            the time.

    Raises:
        UsageError: the folder can't be made.
    """
    if place.is_file():
        return place
    made(place, "--records")
    begun = datetime.now().astimezone().strftime("%Y-%m-%d-%H%M%S")
    numbered = (f"{begun}{f'-{number}' if number > 1 else ''}.jsonl" for number in count(1))
    return next(file for name in numbered if not (file := place / name).exists())


def made(folder: Path, option: str) -> None:
    """Make a folder where it is missing.

    Raises:
        UsageError: it can't be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"{option}: {folder} can't be made: {(error.strerror or '').lower()}") from None
