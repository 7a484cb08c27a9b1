"""What an answer for several goals says, read from its ``statistics`` with every field checked."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final, TypeVar

from serendipity.model import Condition, InputError, PlanStep, Result, Task, Window

_SCHEMA: Final = "serendipity.recognition/1"
_MOST_DIGITS: Final = 10**6
_T = TypeVar("_T")


class MalformedError(Exception):
    """Something that an answer has to say is missing, or of another form."""


@dataclass(frozen=True, slots=True)
class Believed:
    """What the answer says of one candidate goal; figures as in ``serendipity.recognition/1``."""

    name: str
    goal: Condition
    prior: float
    likelihood: float | None
    posterior: float
    with_observed: float | None
    without_observed: float | None
    plan: tuple[str, ...] | None


@dataclass(frozen=True, slots=True)
class Recognised:
    """The posterior that the answer rests on."""

    observed: tuple[str, ...]
    beta: float
    explained: bool
    goals: tuple[Believed, ...]


@dataclass(frozen=True, slots=True)
class StatedGoal:
    """What happens if one goal is the human's."""

    name: str
    probability: float
    human_plan: tuple[str, ...] | None
    cost: float | None
    window: Window | None
    plan: tuple[PlanStep, ...] | None


def read(task: Task, result: Result) -> tuple[Recognised, tuple[StatedGoal, ...]]:
    """The recognition and what happens for each goal that is considered.

    Raises:
        MalformedError: naming the field.
    """
    known = _Fields(_object(result.statistics.get("recognition"), "statistics.recognition"), "recognition")
    if (known.raw("schema"), known.raw("human")) != (_SCHEMA, result.human):
        raise MalformedError(f"statistics.recognition: expected schema '{_SCHEMA}' and the result's human")
    recognised = Recognised(
        known.texts("observed"),
        known.number("beta"),
        known.get("explained", lambda value: value if isinstance(value, bool) else None),
        tuple(_believed(task, entry) for entry in known.objects("goals")),
    )
    listed = result.statistics.get("goals")
    if not isinstance(listed, list):
        raise MalformedError("statistics.goals is not a list")
    served = tuple(_served(_Fields(_object(e, "statistics.goals"), "goals"), result) for e in listed)
    return recognised, served


def weight(probability: float) -> Fraction:
    """The rational behind a rounded probability: a simple one, if it rounds to the same."""
    exact = Fraction(probability)
    simple = exact.limit_denominator(_MOST_DIGITS)
    return simple if float(simple) == probability else exact


class _Fields:
    """An object's fields, each of one type."""

    def __init__(self, data: Mapping[str, Any], where: str) -> None:
        self._data = data
        self._where = where

    def get(self, key: str, read: Callable[[Any], _T | None]) -> _T:
        value = read(self._data.get(key))
        if value is None:
            raise MalformedError(f"{self._where}: '{key}' is missing or of another type")
        return value

    def text(self, key: str) -> str:
        return self.get(key, lambda value: value if isinstance(value, str) else None)

    def texts(self, key: str) -> tuple[str, ...]:
        def read(value: Any) -> tuple[str, ...] | None:
            right = isinstance(value, list) and all(isinstance(item, str) for item in value)
            return tuple(value) if right else None

        return self.get(key, read)

    def number(self, key: str) -> float:
        def read(value: Any) -> float | None:
            right = isinstance(value, int | float) and not isinstance(value, bool)
            return float(value) if right and 0 <= value < float("inf") else None

        return self.get(key, read)

    def objects(self, key: str) -> list["_Fields"]:
        def read(value: Any) -> list[_Fields] | None:
            if not isinstance(value, list):
                return None
            return [_Fields(_object(item, key), f"{self._where}.{key}") for item in value]

        return self.get(key, read)

    def optional(self, key: str, read: Callable[[str], _T]) -> _T | None:
        return None if self.raw(key) is None else read(key)

    def raw(self, key: str) -> Any:
        if key not in self._data:
            raise MalformedError(f"{self._where}: '{key}' is missing")
        return self._data[key]


def _object(value: Any, where: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise MalformedError(f"{where} is not an object")
    return value


def _believed(task: Task, entry: _Fields) -> Believed:
    return Believed(
        entry.text("name"),
        _condition(task, entry.texts("goal")),
        entry.number("prior"),
        entry.optional("likelihood", entry.number),
        entry.number("posterior"),
        entry.optional("cost_with_observed", entry.number),
        entry.optional("cost_without_observed", entry.number),
        entry.optional("plan", entry.texts),
    )


def _condition(task: Task, literals: tuple[str, ...]) -> Condition:
    ids = {fact: i for i, fact in enumerate(task.facts)}
    stranger = next((text for text in literals if text.removeprefix("!") not in ids), None)
    if stranger is not None:
        raise MalformedError(f"there is no fact '{stranger.removeprefix('!')}' in the task")
    true = sorted({ids[text] for text in literals if not text.startswith("!")})
    false = sorted({ids[text[1:]] for text in literals if text.startswith("!")})
    return Condition(tuple(true), tuple(false))


def _served(entry: _Fields, result: Result) -> StatedGoal:
    """One entry; steps and window are read as those of a result are."""
    data = result.to_dict() | {"plan": entry.raw("plan"), "window": entry.raw("window")}
    try:
        parsed = Result.from_dict(data)
    except InputError as error:
        raise MalformedError(f"goals: {error}") from None
    return StatedGoal(
        entry.text("name"),
        entry.number("probability"),
        entry.optional("human_plan", entry.texts),
        entry.optional("cost", entry.number),
        parsed.window,
        parsed.plan,
    )
