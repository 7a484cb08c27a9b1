"""The log of an execution: JSON lines, from which the same run can be played again."""

import json
from collections.abc import Iterable, Iterator, Sequence
from os import PathLike
from typing import Any, Final, NamedTuple

from serendipity.execution.decided import Decided, Outlook
from serendipity.execution.execution import Execution
from serendipity.execution.why import Why
from serendipity.model import Deadline, InputError, Task, UsageError
from serendipity.model.answers.fields import MalformedError, read_fields
from serendipity.model.schemas import schema_fault
from serendipity.pddl.parsing.files import read_text
from serendipity.robot import Epoch, Report

SCHEMA: Final = "serendipity.execution/1"

_LATER: Final[dict[str, Any]] = {"proved": False, "because": None, "wishes": {}}
"""Fields of a decision that logs of the first versions do not have, and what they stand for."""


class LogLine(NamedTuple):
    """A line of a log: its number from 1, and the object that it holds."""

    number: int
    value: dict[str, Any]


def log_lines(run: Execution, /, **notes: Any) -> Iterator[dict[str, Any]]:
    """All lines of a log; the first one, its header, says what was asked.

    Args:
        **notes: whatever else the header is to remember: seed, who the person was.
    """
    options = run.options
    yield {
        "schema": SCHEMA,
        "task": run.task.name,
        "human": run.human,
        "mode": options.mode,
        "discount": str(options.discount),
        "human_model": options.human_model,
        "interference": options.interference,
        **notes,
    }
    yield from run.events


def as_text(lines: Iterable[dict[str, Any]]) -> str:
    """Lines as JSON lines."""
    return "".join(f"{json.dumps(line, ensure_ascii=False)}\n" for line in lines)


def read_logs(file: str | PathLike[str]) -> list[list[LogLine]]:
    """The runs of a file of logs, one after another.

    Raises:
        InputError: it can't be read, a header has another schema, or a line is no JSON object, or comes
            before any header.
    """
    runs: list[list[LogLine]] = []
    for number, text in enumerate(read_text(file).splitlines(), start=1):
        if not text.strip():
            continue
        try:
            value = json.loads(text)
        except (ValueError, RecursionError):  # no JSON, or nested too deeply
            value = None
        if not isinstance(value, dict):
            raise InputError("log: expected a JSON object", file, number)
        if (schema := value.get("schema")) is not None:
            if fault := schema_fault(schema, SCHEMA):
                raise InputError(f"log: {fault}", file, number)
            runs.append([])
        if not runs:
            raise InputError(f"log: expected a line with the schema '{SCHEMA}' first", file, number)
        runs[-1].append(LogLine(number, value))
    if not runs:
        raise InputError("log: is empty", file)
    return runs


def replay(task: Task, lines: Sequence[LogLine], file: object = None) -> Execution:
    """Play a log again: the same decisions, the same person, the same faults.

    Every line has to come out as it is written: what took place, what it cost, and what changed.

    Args:
        lines: of one run, its header first.
        file: named in errors.

    Raises:
        InputError: a line is malformed, or something else happens; it says where.
    """
    first, *rest = lines
    if first.value.get("human") != task.agents[task.human]:
        raise InputError("log: is of another task: it has another human", file, first.number)
    script = _Script(file)
    reported = any("reports" in line.value for line in rest)
    try:
        run = Execution(
            task,
            discount=first.value.get("discount", 0),
            human_model=first.value.get("human_model", "observant"),
            interference=first.value.get("interference", "paper"),
            robots=script,
            adapter=script if reported else None,
        )
    except UsageError as error:
        raise InputError(f"log: {error}", file, first.number) from None
    for line in rest:
        script.line = line
        try:
            _play(run, line.value)
        except (KeyError, TypeError, AttributeError, ValueError):
            raise InputError("log: expected an epoch, a change or a drop", file, line.number) from None
        except UsageError as error:
            raise InputError(f"log: {error}", file, line.number) from None
        _compare(run.events[-1], line, file)
    return run


def decision_of(value: dict[str, Any], epoch: int, file: object = None) -> Decided:
    """A decision that a log holds.

    Args:
        value: what stands there.
        epoch: that it is for.
        file: named in errors.

    Raises:
        InputError: a step is malformed.
        KeyError: a field is missing.
    """
    try:
        steps = read_fields(Decided, value, ("actions", "offers", "expected", "plan", "window"))
    except MalformedError as error:
        raise InputError(f"log: {error}", file) from None
    return Decided(
        epoch,
        value["verdict"],
        value["reason"],
        **steps,
        cost=value["cost"],
        alone=value["alone"],
        proved=value.get("proved", _LATER["proved"]),
        goals=value["goals"],
        wishes=value.get("wishes", _LATER["wishes"]),
        seconds=value["seconds"],
        because=None if value.get("because") is None else Why.from_dict(value["because"]),
    )


def _play(run: Execution, value: dict[str, Any]) -> None:
    if "change" in value:
        run.change(dict(value["change"]))
    elif "drop" in value:
        run.drop(list(value["drop"]))
    else:
        run.step(value["human"])


def _compare(event: dict[str, Any], line: LogLine, file: object) -> None:
    for key, value in event.items():
        told = line.value.get(key)
        if _comparable(told) != _comparable(value):
            message = f"log: {key}: comes out as {value!r:.100}, but the log says {told!r:.100}"
            raise InputError(message, file, line.number)


def _comparable(value: Any) -> Any:
    """A value; a decision without the time that it took, which is another one each time."""
    return {**_LATER, **value, "seconds": None} if isinstance(value, dict) and "seconds" in value else value


class _Script:
    """Robots that decide, and succeed, as a log says."""

    def __init__(self, file: object) -> None:
        self.line = LogLine(0, {})
        self.goals: dict[str, float] = {}
        self._file = file

    def decide(self, outlook: Outlook, _deadline: Deadline) -> Decided:
        """The decision of the line."""
        return decision_of(self.line.value["decision"], outlook.epoch, self._file)

    def execute(self, _epoch: Epoch) -> list[Report]:
        """What the line says that robots reported."""
        told = self.line.value.get("reports", ())
        return [Report(one["outcome"], one["seconds"], one["note"]) for one in told]

    def close(self) -> None:
        """There is nothing to give back."""

    def saw(self, own: int | None, executed: Sequence[int], tried: int | None = None) -> None:
        """Nothing is learnt."""

    def surprised(self) -> None:
        """Nothing is a surprise."""

    def drop(self, robots: Iterable[int]) -> None:
        """The log knows."""

    def unable(self, actions: Iterable[int]) -> None:
        """The log knows."""
