"""The answer to a planning call, and its JSON form (schema ``serendipity.result/1``)."""

import math
from dataclasses import dataclass, field, replace
from typing import Any, Final

from serendipity.model.errors import InputError, UsageError
from serendipity.model.options import MAX_EPOCH, Options
from serendipity.model.plans import Window
from serendipity.model.policy import Policy

SCHEMA: Final = "serendipity.result/1"
STATUSES: Final = ("optimal", "feasible", "infeasible", "unknown")


@dataclass(frozen=True, slots=True)
class PlanStep:
    """One action of a reported plan; a joint action is one step with all its agents.

    Attributes:
        epoch: from 1.
        agents: names of the participants.
        action: its PDDL text without brackets.
        cost: what it costs the team, discounted, in the domain's unit.
    """

    epoch: int
    agents: tuple[str, ...]
    action: str
    cost: float

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of a step; plain values only."""
        return {
            "epoch": self.epoch,
            "agents": list(self.agents),
            "action": self.action,
            "cost": self.cost,
        }


@dataclass(frozen=True, slots=True)
class Result:
    """What ``plan`` answers; fields as in ``docs/reference`` (costs in the domain's unit).

    ``status``: ``optimal`` (proved), ``feasible`` (a plan; the limit came first),
    ``infeasible`` (proved; ``reason`` says why) or ``unknown`` (the limit came first).
    """

    mode: str
    status: str
    human: str
    options: Options
    human_plan: tuple[str, ...] | None = None
    human_cost: float | None = None
    opportunity: bool = False
    cost: float | None = None
    saving: float | None = None
    objective: float | None = None
    lower_bound: float | None = None
    horizon: int | str | None = None
    window: Window | None = None
    reason: str | None = None
    saving_alone: float | None = None
    plan: tuple[PlanStep, ...] | None = None
    agent_costs: dict[str, float] = field(default_factory=dict)
    realised: dict[str, bool] = field(default_factory=dict)
    statistics: dict[str, Any] = field(default_factory=dict)
    policy: Policy | None = None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        window = None if self.window is None else {"start": self.window.start, "end": self.window.end}
        plan = None if self.plan is None else [step.to_dict() for step in self.plan]
        return {
            "schema": SCHEMA,
            "mode": self.mode,
            "status": self.status,
            "human": self.human,
            "human_plan": None if self.human_plan is None else list(self.human_plan),
            "human_cost": self.human_cost,
            "opportunity": self.opportunity,
            "cost": self.cost,
            "saving": self.saving,
            "objective": self.objective,
            "lower_bound": self.lower_bound,
            "horizon": self.horizon,
            "window": window,
            "reason": self.reason,
            "saving_alone": self.saving_alone,
            "plan": plan,
            "agent_costs": dict(self.agent_costs),
            "realised": dict(self.realised),
            "options": self.options.to_dict(),
            "statistics": dict(self.statistics),
            "policy": None if self.policy is None else self.policy.to_dict(),
        }

    @classmethod
    def from_dict(cls, data: Any, file: object = None) -> "Result":
        """The result that a JSON object writes down.

        Args:
            data: what ``json.load`` returned.
            file: named in errors.

        Raises:
            InputError: another schema, a missing field, a value of the wrong type, a
                number that is not finite or is negative, an epoch out of range.
        """
        return _Reader(data, file).result()

    def checked(self) -> "Result":
        """This result as its JSON would be read: for results that somebody made by hand.

        Raises:
            InputError: a field has a type or a value that no result has.
        """
        try:
            data = self.to_dict()
        except (AttributeError, TypeError, ValueError) as error:
            raise InputError(f"result: a field is of another type: {error}") from None
        return replace(_Reader(data, None).result(), options=self.options)


class _Reader:
    """Reads a result object field by field, with one clear line for what is wrong."""

    def __init__(self, data: Any, file: object) -> None:
        self.file = file
        if not isinstance(data, dict):
            raise self._error(f"expected a JSON object, got {type(data).__name__}")
        if data.get("schema") != SCHEMA:
            raise self._error(f"schema: expected '{SCHEMA}', got {data.get('schema')!r:.50}")
        self.data = data

    def result(self) -> Result:
        options = self._options()
        status = self._text("status")
        if status not in STATUSES:
            raise self._error(f"status: expected one of {', '.join(STATUSES)}, got {status!r:.50}")
        mode = self._text("mode")
        if mode != options.mode:
            raise self._error(f"mode: is {mode!r:.50}, but '{options.mode}' in the options")
        return Result(
            mode=mode,
            status=status,
            human=self._text("human"),
            options=options,
            human_plan=self._names("human_plan"),
            human_cost=self._number("human_cost"),
            opportunity=self._flag("opportunity"),
            cost=self._number("cost"),
            saving=self._number("saving", signed=True),
            objective=self._number("objective"),
            lower_bound=self._number("lower_bound"),
            horizon=self._horizon(),
            window=self._window(),
            reason=self._optional_text("reason"),
            saving_alone=self._number("saving_alone"),
            plan=self._plan(),
            agent_costs=self._costs("agent_costs"),
            realised=self._verdicts("realised"),
            statistics=self._mapping("statistics"),
            policy=self._policy(),
        )

    def _error(self, message: str) -> InputError:
        return InputError(f"result: {message}", self.file)

    def _field(self, key: str) -> Any:
        if key not in self.data:
            raise self._error(f"the field '{key}' is missing")
        return self.data[key]

    def _text(self, key: str) -> str:
        value = self._field(key)
        if not isinstance(value, str):
            raise self._error(f"{key}: expected a text, got {value!r:.50}")
        return value

    def _optional_text(self, key: str) -> str | None:
        return None if self._field(key) is None else self._text(key)

    def _flag(self, key: str) -> bool:
        value = self._field(key)
        if not isinstance(value, bool):
            raise self._error(f"{key}: expected true or false, got {value!r:.50}")
        return value

    def _number(self, key: str, *, signed: bool = False) -> float | None:
        value = self._field(key)
        return None if value is None else self._finite(value, key, signed=signed)

    def _finite(self, value: Any, where: str, *, signed: bool = False) -> float:
        try:
            number = float(value) if isinstance(value, int | float) else math.nan
        except OverflowError:
            number = math.inf
        if isinstance(value, bool) or not math.isfinite(number):
            raise self._error(f"{where}: expected a finite number, got {value!r:.50}")
        if number < 0 and not signed:
            raise self._error(f"{where}: expected a number of at least 0, got {value!r:.50}")
        return number

    def _epoch(self, value: Any, where: str) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= MAX_EPOCH:
            raise self._error(f"{where}: expected an epoch from 1 to {MAX_EPOCH}, got {value!r:.50}")
        return value

    def _mapping(self, key: str) -> dict[str, Any]:
        value = self._field(key)
        if not isinstance(value, dict):
            raise self._error(f"{key}: expected an object, got {value!r:.50}")
        return value

    def _verdicts(self, key: str) -> dict[str, bool]:
        verdicts = self._mapping(key)
        if not all(isinstance(verdict, bool) for verdict in verdicts.values()):
            raise self._error(f"{key}: expected true or false for each human model")
        return verdicts

    def _costs(self, key: str) -> dict[str, float]:
        return {name: self._finite(cost, f"{key}.{name}") for name, cost in self._mapping(key).items()}

    def _names(self, key: str) -> tuple[str, ...] | None:
        value = self._field(key)
        if value is None:
            return None
        if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
            raise self._error(f"{key}: expected a list of action names")
        return tuple(value)

    def _options(self) -> Options:
        try:
            return Options.from_dict(self._mapping("options"))
        except UsageError as error:
            raise self._error(str(error)) from None

    def _horizon(self) -> int | str | None:
        value = self._field("horizon")
        if value is None or value == "inf":
            return value  # type: ignore[no-any-return]
        return 0 if value == 0 and not isinstance(value, bool) else self._epoch(value, "horizon")

    def _window(self) -> Window | None:
        value = self._field("window")
        if value is None:
            return None
        if not isinstance(value, dict) or set(value) != {"start", "end"}:
            raise self._error(f"window: expected an object with 'start' and 'end', got {value!r:.50}")
        start = self._epoch(value["start"], "window.start")
        end = self._epoch(value["end"], "window.end")
        if start >= end:
            raise self._error(f"window: expected start < end, got [{start}, {end})")
        return Window(start, end)

    def _policy(self) -> Policy | None:
        value = self.data.get("policy")  # only answers of mode assistance need to have one
        return None if value is None else Policy.from_dict(value, self.file)

    def _plan(self) -> tuple[PlanStep, ...] | None:
        value = self._field("plan")
        if value is None:
            return None
        if not isinstance(value, list):
            raise self._error(f"plan: expected a list of steps, got {value!r:.50}")
        return tuple(self._step(step, f"plan[{i}]") for i, step in enumerate(value))

    def _step(self, step: Any, where: str) -> PlanStep:
        if not isinstance(step, dict) or set(step) != {"epoch", "agents", "action", "cost"}:
            raise self._error(f"{where}: expected an object with epoch, agents, action and cost only")
        agents, action = step["agents"], step["action"]
        if not isinstance(agents, list) or not all(isinstance(name, str) for name in agents):
            raise self._error(f"{where}.agents: expected a list of names, got {agents!r:.50}")
        if not isinstance(action, str):
            raise self._error(f"{where}.action: expected a text, got {action!r:.50}")
        cost = self._finite(step["cost"], f"{where}.cost")
        return PlanStep(self._epoch(step["epoch"], f"{where}.epoch"), tuple(agents), action, cost)
