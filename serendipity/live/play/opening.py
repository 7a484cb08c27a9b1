"""What the command line asks for, as something that pages can be opened on."""

from datetime import datetime
from itertools import count
from pathlib import Path
from typing import Any

from serendipity.live.play.questions import texts
from serendipity.live.play.scenarios import scenarios
from serendipity.live.play.setting import Setting
from serendipity.live.play.study import Study
from serendipity.live.play.table import Table
from serendipity.model import Task, UsageError


def open_table(name: str, task: Task, file: Path | None = None, **how: Any) -> Table:
    """Rounds of one task.

    Args:
        name: of the task, for people.
        task: the task.
        file: where every event is written down when it happens; None: nowhere.
        **how: the other fields of :class:`.setting.Setting`.

    Raises:
        SerendipityError: the human can't reach the goal alone, or ``goals`` are wrong.
        UsageError: the file can't be written.
    """
    return Table(Setting(name, task, **how), file)


def record_in(folder: Path) -> Path:
    """A file of its own for what is played from now on, named after the time; the folder is made.

    Raises:
        UsageError: the folder can't be made.
    """
    _made(folder, "--records")
    begun = datetime.now().astimezone().strftime("%Y-%m-%d-%H%M%S")
    numbered = (f"{begun}{f'-{number}' if number > 1 else ''}.jsonl" for number in count(1))
    return next(file for name in numbered if not (file := folder / name).exists())


def open_study(folder: Path, rounds: int, seed: int, **how: Any) -> Study:
    """A study with seeded scenarios.

    Args:
        folder: where records go, and texts come from; made where it is missing.
        rounds: scenarios of each participant.
        seed: of scenarios and conditions.
        **how: the other fields of :class:`.setting.Setting`.

    Raises:
        UsageError: the folder can't be made, or help pays in too few scenarios.
        InputError: a text of the folder is wrong.
    """
    if how.get("goals") is not None:
        raise UsageError("--goals: goes with a task, not with --study")
    _made(folder, "--study")
    drawn = scenarios(rounds, seed, how["discount"])
    return Study([Setting(name, task, **how) for name, task in drawn], folder, texts(folder), seed)


def _made(folder: Path, option: str) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"{option}: {folder} can't be made: {(error.strerror or '').lower()}") from None
