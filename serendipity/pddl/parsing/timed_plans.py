"""Plan files that say when actions begin.

``12: (walk ann bed sink)`` or ``12: (walk ann bed sink) [4]``, as planning competitions write plans: the time
from 0, in the unit of PDDL's durations, and the duration.  In our own plan files a comment, ``; epoch 13``,
stands before what begins in that epoch, from 1.  Lines that are numbered 1, 2, 3 and so on are epochs, too.
"""

import re
from collections.abc import Sequence
from fractions import Fraction
from math import ceil
from typing import Final, NamedTuple

from serendipity.model import InputError, Task
from serendipity.model.numbers import plain
from serendipity.model.options import MAX_EPOCH
from serendipity.model.task.names import canonical_name
from serendipity.model.task.plans import PlanEntry
from serendipity.pddl.parsing.lists import action_of, actions_in, starts_json

_TIME: Final = re.compile(r"^(\d+(?:\.\d*)?|\.\d+)\s*:\s*")
_EARLY: Final = re.compile(r"^(-\d+(?:\.\d*)?)\s*:")
_DURATION: Final = re.compile(r"\s*\[\s*(\d+(?:\.\d*)?|\.\d+)\s*\]$")
_EPOCH: Final = re.compile(r"^[;#]\s*epoch\s+(\d+)\s*$", re.IGNORECASE)
_COMMENT: Final = re.compile(r"[;#].*")

_NEAR: Final = Fraction(1, 100)
"""Of an epoch: planners put a little time between actions, which is none."""


class PlanLine(NamedTuple):
    """An action of a plan file.

    Attributes:
        time: when it begins, from 0, in the unit of durations; None where that is not said.
        epoch: in which it begins, from 1; None where that is not said.
        duration: that it is said to take, or None.
    """

    name: str
    line: int
    time: Fraction | None = None
    epoch: int | None = None
    duration: Fraction | None = None

    @property
    def timed(self) -> bool:
        """Whether it is said when it begins."""
        return self.time is not None or self.epoch is not None


def plan_lines(text: str, path: object, what: str = "") -> list[PlanLine]:
    """The actions of a plan file: all of them with times, or none.

    Args:
        what: what errors begin with: ``"human plan: "``.

    Raises:
        InputError: a line is not one action, or some actions have times and others have not.
    """
    if starts_json(text):
        return [PlanLine(name, line) for name, line in actions_in(text, path, what)]
    found: list[PlanLine] = []
    epoch: int | None = None
    for number, line in enumerate(text.splitlines(), start=1):
        said = _EPOCH.match(line.strip())
        epoch = int(said[1]) if said else epoch
        bare = _COMMENT.sub("", line).strip()
        if bare:
            found.append(_line(bare, path, number, what)._replace(epoch=epoch))
    found = [one for one in found if one.name]
    if [one.time for one in found] == [*range(1, len(found) + 1)] and not any(one.duration for one in found):
        return [one._replace(time=None) for one in found]
    untimed = next((one for one in found if not one.timed), None)
    if untimed is not None and any(one.timed for one in found):
        raise InputError(f"{what}expected a time, as in '12: (walk ann bed sink)'", path, untimed.line)
    return found


def entries(lines: Sequence[PlanLine], task: Task, path: object, what: str = "") -> list[PlanEntry]:
    """The actions with the epochs in which they begin, or as they are where no times are said.

    Raises:
        InputError: a time is no beginning of an epoch, or a duration is another one than the task's.
    """
    found: list[PlanEntry] = []
    for one in lines:
        _check_duration(one, task, path, what)
        if one.time is not None:
            found.append((_begun(one, one.time, task, path, what), one.name))
        else:
            found.append(one.name if one.epoch is None else (one.epoch, one.name))
    return found


def timed_line(task: Task, epoch: int, name: str, duration: int) -> str:
    """A line that says when an action begins and how long it takes: ``12.000: (walk ann bed sink) [4.000]``.

    Where an epoch is no round number its times are, within a hundredth of one.

    Args:
        epoch: in which it begins, from 1.
        duration: epochs that it takes.
    """
    digits = 3
    while task.epoch * 10**digits < 100:
        digits += 1
    start, length = (f"{float(number * task.epoch):.{digits}f}" for number in (epoch - 1, duration))
    return f"{start}: ({name}) [{length}]"


def _line(bare: str, path: object, number: int, what: str) -> PlanLine:
    early = _EARLY.match(bare)
    if early is not None:
        raise InputError(f"{what}expected a time from 0 on, got {early[1]}", path, number)
    time = _TIME.match(bare)
    duration = _DURATION.search(bare)
    body = _DURATION.sub("", bare[time.end() :] if time else bare)
    return PlanLine(
        action_of(body, path, number, what),
        number,
        time=Fraction(time[1]) if time else None,
        duration=Fraction(duration[1]) if duration else None,
    )


def _begun(one: PlanLine, time: Fraction, task: Task, path: object, what: str) -> int:
    epochs = time / task.epoch
    whole = round(epochs)
    if abs(epochs - whole) > _NEAR:
        each = plain(task.epoch)
        raise InputError(
            f"{what}expected a multiple of {each}, which an epoch takes, got {plain(time)}", path, one.line
        )
    if whole >= MAX_EPOCH:
        raise InputError(f"{what}expected at most {MAX_EPOCH:,} epochs, got {whole + 1:,}", path, one.line)
    return whole + 1


def _check_duration(one: PlanLine, task: Task, path: object, what: str) -> None:
    ids = task.named.get(canonical_name(one.name), ())
    if one.duration is None or not ids:
        return
    takes = task.actions[ids[0]].duration
    if ceil(one.duration / task.epoch - _NEAR) != takes:
        known = plain(takes * task.epoch)
        got = plain(one.duration)
        raise InputError(
            f"{what}expected [{known}], the duration of '{one.name}', got [{got}]", path, one.line
        )
