"""What some answers say beside their plan: over ties, for several goals, of a policy, over time.

In JSON these parts stand in ``statistics``.  A part of a file that does not have its form stays there as
it is, and what is wrong with it is told (``Result.malformed``): the verifier refutes answers that need it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from serendipity.model.answers.answer import PolicyBounds
from serendipity.model.answers.fields import Fields, MalformedError, finite, names
from serendipity.model.answers.policy import Costs
from serendipity.model.answers.recognition import read_recognition
from serendipity.model.answers.step_reader import StepReader
from serendipity.model.errors import InputError, UsageError
from serendipity.model.numbers import MOST_IN_RESULTS, exact
from serendipity.model.task.plans import PlanStep, Window


@dataclass(frozen=True, slots=True)
class TiedAnswer:
    """The answer for one of the human's optimal plans (semantics 1).

    Attributes:
        human_plan: names of ``pi_H``.
        cost: what the answer costs the team, or None without a plan.
        opportunity: whether a robot helps.
        realised: verdicts on humans who replan, by model; None where nobody has looked.
        plan: what everybody does, where it is not proved that nothing is better; else None.
        window: of that plan.
    """

    human_plan: tuple[str, ...]
    cost: float | None
    opportunity: bool
    realised: dict[str, bool] | None = None
    plan: tuple[PlanStep, ...] | None = None
    window: Window | None = None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        data: dict[str, Any] = {
            "human_plan": list(self.human_plan),
            "cost": self.cost,
            "opportunity": self.opportunity,
        }
        if self.realised is not None:
            data["realised"] = dict(self.realised)
        if self.plan is not None:
            data["window"] = None if self.window is None else self.window.to_dict()
            data["plan"] = [step.to_dict() for step in self.plan]
        return data


@dataclass(frozen=True, slots=True)
class GoalAnswer:
    """What happens if one goal is the human's (semantics 8).

    Attributes:
        name: of the goal.
        probability: among the goals that are considered.
        human_plan: names of the human's current plan, or None where that is not known.
        cost: what it costs the team, or None without a plan.
        window: in which that plan is interrupted, or None.
        plan: what everybody does, or None.
    """

    name: str
    probability: float
    human_plan: tuple[str, ...] | None
    cost: float | None
    window: Window | None
    plan: tuple[PlanStep, ...] | None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            "name": self.name,
            "probability": self.probability,
            "human_plan": None if self.human_plan is None else list(self.human_plan),
            "cost": self.cost,
            "window": None if self.window is None else self.window.to_dict(),
            "plan": None if self.plan is None else [step.to_dict() for step in self.plan],
        }


class GapEntry(NamedTuple):
    """Objective and lower bound as they were known after some seconds; None while there was none."""

    seconds: float
    objective: float | None
    lower_bound: float | None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return self._asdict()


def bounds_to_dict(bounds: PolicyBounds) -> dict[str, Any]:
    """The JSON object of both sides of a policy's value; costs as exact texts."""
    upper = None if bounds.upper is None else [str(cost) for cost in bounds.upper]
    return {"lower": [str(cost) for cost in bounds.lower], "upper": upper}


def read_parts(statistics: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any], dict[str, str]]:
    """The parts by name, the statistics without them, and by name what is wrong with other parts."""
    parts: dict[str, Any] = {}
    malformed: dict[str, str] = {}
    for name, read in _READERS.items():
        if name in statistics:
            try:
                parts[name] = read(statistics[name])
            except MalformedError as error:
                malformed[name] = str(error)
    return parts, {name: value for name, value in statistics.items() if name not in parts}, malformed


def _gap(value: Any) -> tuple[GapEntry, ...]:
    if not isinstance(value, list):
        raise MalformedError("statistics.gap is not a list")
    entries = [Fields(item, "statistics.gap", "gap") for item in value]
    return tuple(
        GapEntry(
            entry.number("seconds"),
            entry.optional("objective", entry.number),
            entry.optional("lower_bound", entry.number),
        )
        for entry in entries
    )


def _ties(value: Any) -> tuple[TiedAnswer, ...]:
    if not isinstance(value, list | tuple):
        raise MalformedError("statistics.ties does not list the answers for his optimal plans")
    return tuple(map(_tied, value))


def _tied(entry: Any) -> TiedAnswer:
    if not isinstance(entry, Mapping):
        raise MalformedError("statistics.ties: expected an object for each answer")
    human_plan, cost, opportunity, realised = (
        entry.get(key) for key in ("human_plan", "cost", "opportunity", "realised")
    )
    read = names(human_plan)
    if read is None:
        raise MalformedError("statistics.ties: expected human_plan to be a list of actions")
    number = finite(cost)
    if "cost" not in entry or (number is None and cost is not None):
        raise MalformedError("statistics.ties: expected cost to be a number or null")
    if not isinstance(opportunity, bool):
        raise MalformedError("statistics.ties: expected opportunity to be true or false")
    if realised is not None and not _are_verdicts(realised):
        raise MalformedError("statistics.ties: expected realised to be true or false for each human model")
    try:
        plan, window = StepReader(None).plan(entry.get("plan")), StepReader(None).window(entry.get("window"))
    except InputError as error:
        raise MalformedError(f"statistics.ties: {error}") from None
    return TiedAnswer(read, number, opportunity, realised, plan, window)


def _are_verdicts(value: Any) -> bool:
    return isinstance(value, dict) and all(isinstance(verdict, bool) for verdict in value.values())


def _optimal_plans(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise MalformedError("statistics.optimal_plans is not a number of plans")
    return value


def _bounds(value: Any) -> PolicyBounds:
    if not isinstance(value, Mapping) or set(value) != {"lower", "upper"}:
        raise MalformedError("statistics.bounds: expected an object with 'lower' and 'upper'")
    lower = _pair(value["lower"])
    if lower is None:
        raise MalformedError("statistics.bounds.lower: expected a pair of costs")
    return PolicyBounds(lower, _pair(value["upper"]))


def _pair(value: Any) -> Costs | None:
    """Two costs from their exact texts; None for null."""
    if value is None:
        return None
    texts = names(value)
    if texts is None or len(texts) != 2:
        raise MalformedError("statistics.bounds: expected the human's and the robot's cost as texts")
    try:
        first, second = (exact(cost, "statistics.bounds", MOST_IN_RESULTS) for cost in texts)
    except UsageError as error:
        raise MalformedError(str(error)) from None
    return first, second


def _goals(value: Any) -> tuple[GoalAnswer, ...]:
    if not isinstance(value, list):
        raise MalformedError("statistics.goals is not a list")
    return tuple(_goal(Fields(entry, "statistics.goals", "goals")) for entry in value)


def _goal(entry: Fields) -> GoalAnswer:
    """One entry; steps and window are read as those of a result are."""
    plan, window = entry.raw("plan"), entry.raw("window")
    reader = StepReader(None)
    try:
        read_window, read_plan = reader.window(window), reader.plan(plan)
    except InputError as error:
        raise MalformedError(f"goals: {error}") from None
    return GoalAnswer(
        entry.text("name"),
        entry.number("probability"),
        entry.optional("human_plan", entry.texts),
        entry.optional("cost", entry.number),
        read_window,
        read_plan,
    )


_READERS: Final[dict[str, Callable[[Any], Any]]] = {
    "gap": _gap,
    "ties": _ties,
    "optimal_plans": _optimal_plans,
    "bounds": _bounds,
    "recognition": read_recognition,
    "goals": _goals,
}
"""By name in ``statistics``, which is that of the attribute; in the order in which they are written."""
