"""The JSON form of results (schema ``serendipity.result/1``): which field stands where, and exact figures.

Parts that only some answers have stand in ``statistics``.  A part of a file that is of another form stays
there as it is, and what is wrong with it is told: the verifier refutes answers that need it.
"""

from collections.abc import Iterable, Sequence
from typing import Any, Final

from serendipity.model.answers.answer import PolicyBounds
from serendipity.model.answers.fields import (
    Form,
    MalformedError,
    checked,
    finite,
    form_of,
    is_whole,
    kind_in_json,
    mapping,
    number,
    optional,
    read_fields,
    written,
)
from serendipity.model.answers.policy import Policy, read_policy
from serendipity.model.answers.recognition import Recognition, read_recognition
from serendipity.model.answers.result_parts import GapEntry, GoalAnswer, HelpedPerson, TiedAnswer
from serendipity.model.errors import UsageError
from serendipity.model.numbers import MOST_IN_RESULTS, Figure, exact
from serendipity.model.options import MAX_EPOCH, Options
from serendipity.model.schemas import schema_fault
from serendipity.model.task.plans import PlanTimes

SCHEMA: Final = "serendipity.result/1"

_IN_JSON: Final = (
    "version",
    "mode",
    "status",
    "human",
    "human_plan",
    "human_cost",
    "opportunity",
    "cost",
    "saving",
    "objective",
    "lower_bound",
    "horizon",
    "window",
    "reason",
    "saving_alone",
    "plan",
    "agent_costs",
    "realised",
    "options",
    "statistics",
    "policy",
)
"""The fields that stand in JSON by themselves, in this order."""

_PARTS: Final = ("gap", "ties", "optimal_plans", "bounds", "recognition", "goals", "humans")
"""The fields that stand in ``statistics`` there, if they are known."""

_IN_TIME: Final = ("human_plan_times", "bystanders")
"""The fields that stand there behind these, where they say something."""

_LATER: Final[dict[str, Any]] = {"version": None, "policy": None, "human_plan_times": None, "bystanders": {}}
"""Fields that results of the first versions, or without time, do not have, and what they stand for."""


def object_of(result: Any) -> dict[str, Any]:
    """The JSON object of a result; see :meth:`serendipity.model.Result.to_dict`."""
    parts = written(result, (name for name in _PARTS if getattr(result, name) is not None))
    timed = (name for name in _IN_TIME if getattr(result, name))
    data = {"schema": SCHEMA, **written(result, (*_IN_JSON, *timed))}
    data["statistics"] = {**result.statistics, **parts}
    if result.says("goals") and (result.goals is None or len(result.goals) > 1):
        data["options"]["policy"] = result.options.policy
    texts = exact_texts(data)
    return data if texts is None else {**data, "exact": texts}


def fields_of(kind: type, data: Any) -> dict[str, Any]:
    """The fields that the JSON object of a result writes down; ``kind`` is the class that has them."""
    if not isinstance(data, dict):
        raise MalformedError(f"expected a JSON object, got {kind_in_json(data)}")
    if fault := schema_fault(data.get("schema"), SCHEMA):
        raise MalformedError(fault)
    given = _LATER | with_exact(data, data.get("exact", {}), "exact")
    if _is_committed(given):
        given["options"] = {**given["options"], "policy": "fixed"}
    found = read_fields(kind, given, (*_IN_JSON, *_IN_TIME))
    if found["mode"] != found["options"].mode:
        raise MalformedError(f"mode: is {found['mode']!r:.50}, but '{found['options'].mode}' in the options")
    _require_starts(found["human_plan_times"], found["human_plan"])
    statistics = found["statistics"]
    parts: dict[str, Any] = {}
    malformed = {}
    for name in _PARTS:
        if name in statistics:
            try:
                read = read_fields(kind, statistics, (name,), "statistics")
                for said in (read[name] or ()) if name in ("goals", "ties") else ():
                    _require_starts(said.human_plan_times, said.human_plan, f"statistics.{name}: ")
                parts |= read
            except MalformedError as error:
                malformed[name] = str(error)
    left = {name: value for name, value in statistics.items() if name not in parts}
    return {**found, **parts, "statistics": left, "malformed": malformed}


def _require_starts(times: PlanTimes | None, names: Sequence[str] | None, where: str = "") -> None:
    """Return if a plan has a time for each action, or none at all."""
    count = len(names or ())
    if times is not None and len(times.starts) != count:
        raise MalformedError(f"{where}human_plan_times: expected {count} starts, got {len(times.starts)}")


def _is_committed(data: dict[str, Any]) -> bool:
    """Whether an answer for several goals is of a time when robots committed themselves."""
    options, statistics = data.get("options"), data.get("statistics")
    if not isinstance(options, dict) or not isinstance(statistics, dict) or "policy" in options:
        return False
    goals = statistics.get("goals")
    return isinstance(goals, list) and len(goals) > 1


def _read_options(value: Any, where: str) -> Options:
    try:
        return Options.from_dict(dict(mapping(value, where)))
    except UsageError as error:
        raise MalformedError(str(error)) from None


def _read_horizon(value: Any, where: str) -> Any:
    if value is None or value == "inf":
        return value
    return checked(value, where, f"an epoch from 1 to {MAX_EPOCH}", is_whole(value, most=MAX_EPOCH))


FORMS: Final = {
    "options": Form(_read_options, Options.to_dict),
    "saving": optional(Form(number)),
    "horizon": Form(_read_horizon),
    "statistics": Form(mapping),
    "policy": optional(Form(read_policy, Policy.to_dict)),
    "gap": form_of(tuple[GapEntry, ...]),
    "ties": form_of(tuple[TiedAnswer, ...]),
    "optimal_plans": Form(lambda value, where: checked(value, where, "a number of plans", is_whole(value))),
    "bounds": form_of(PolicyBounds),
    "recognition": Form(read_recognition, Recognition.to_dict),
    "goals": form_of(tuple[GoalAnswer, ...]),
    "humans": form_of(tuple[HelpedPerson, ...]),
}
"""The forms of fields that do not follow from their types."""


def exact_texts(value: Any) -> Any:
    """Texts of the figures in a JSON value whose floats do not say it all, in its shape; None without any."""
    if isinstance(value, Figure):
        return str(value.exact)
    texts = {str(key): exact_texts(part) for key, part in _parts(value)}
    return {key: text for key, text in texts.items() if text is not None} or None


def with_exact(value: Any, texts: Any, where: str) -> Any:
    """A JSON value with the exact figures that :func:`exact_texts` made of it."""
    if isinstance(texts, dict):
        parts = {str(key): part for key, part in _parts(value)}
        for key, text in texts.items():
            parts[key] = with_exact(parts.get(key), text, f"{where}.{key}")
        return list(parts.values()) if isinstance(value, list) else parts
    number = finite(value)
    try:
        found = Figure(exact(texts, where, MOST_IN_RESULTS)) if isinstance(texts, str) else None
    except UsageError as error:
        raise MalformedError(str(error)) from None
    if number is None or found != number:
        raise MalformedError(f"{where}: expected the exact text of {value!r:.50}, got {texts!r:.50}")
    return found


def _parts(value: Any) -> Iterable[tuple[Any, Any]]:
    if isinstance(value, dict):
        return value.items()
    return enumerate(value) if isinstance(value, list | tuple) else ()
