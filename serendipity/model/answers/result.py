"""The answer to a planning call, and its JSON form (schema ``serendipity.result/1``)."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any, Final, get_args

from serendipity._version import __version__
from serendipity.model.answers.answer import PolicyBounds, Status
from serendipity.model.answers.fields import MalformedError, exact_texts, finite, names, with_exact
from serendipity.model.answers.policy import Policy
from serendipity.model.answers.recognition import Recognition
from serendipity.model.answers.result_parts import (
    GapEntry,
    GoalAnswer,
    TiedAnswer,
    bounds_to_dict,
    read_parts,
)
from serendipity.model.answers.step_reader import StepReader
from serendipity.model.errors import InputError, UsageError
from serendipity.model.keywords import Horizon, Mode
from serendipity.model.numbers import plain
from serendipity.model.options import Options
from serendipity.model.schemas import schema_fault
from serendipity.model.table import Table, Tabular
from serendipity.model.task.plans import PlanStep, Window
from serendipity.model.telling import Grid, Line, Told, json_of

SCHEMA: Final = "serendipity.result/1"
_COLUMNS: Final = {"epoch": int, "agents": str, "action": str, "cost": float}
STATUSES: Final[tuple[Status, ...]] = get_args(Status)


@dataclass(frozen=True, slots=True, repr=False)
class Result(Tabular, Told):
    """What ``plan`` answers; fields as in ``docs/reference`` (costs in the domain's unit).

    ``status``: ``optimal`` (proved), ``feasible`` (a plan; the limit came first),
    ``infeasible`` (proved; ``reason`` says why) or ``unknown`` (the limit came first).

    ``statistics`` has figures of the call.  What only some answers have is typed, None elsewhere, and
    stands in ``statistics`` in JSON only: ``ties`` (the answers for single optimal plans of the human)
    and ``optimal_plans`` (how many there are), ``goals`` and ``recognition`` (where their goal is not
    known), ``bounds`` (mode ``assistance``), ``gap`` (how the answer got better).  A part of a file that
    is of another form stays in ``statistics``, and ``malformed`` says what is wrong with it.

    ``version`` is that of the program that made it; None where its file does not say.
    """

    mode: Mode
    status: Status
    human: str
    options: Options
    human_plan: tuple[str, ...] | None = None
    human_cost: float | None = None
    opportunity: bool = False
    cost: float | None = None
    saving: float | None = None
    objective: float | None = None
    lower_bound: float | None = None
    horizon: Horizon | None = None
    window: Window | None = None
    reason: str | None = None
    saving_alone: float | None = None
    plan: tuple[PlanStep, ...] | None = None
    agent_costs: dict[str, float] = field(default_factory=dict)
    realised: dict[str, bool] = field(default_factory=dict)
    statistics: dict[str, Any] = field(default_factory=dict)
    policy: Policy | None = None
    ties: tuple[TiedAnswer, ...] | None = None
    optimal_plans: int | None = None
    goals: tuple[GoalAnswer, ...] | None = None
    recognition: Recognition | None = None
    bounds: PolicyBounds | None = None
    gap: tuple[GapEntry, ...] | None = field(default=None, compare=False)  # it depends on the clock
    malformed: dict[str, str] = field(default_factory=dict)
    version: str | None = field(default_factory=lambda: __version__, compare=False)

    def figure(self, name: str) -> int | float | None:
        """A number of the statistics; None where there is none of that name."""
        value = self.statistics.get(name)
        return None if finite(value) is None else value

    def table(self) -> Table:
        """The plan, a step a row; no row without a plan."""
        rows = tuple((step.epoch, ", ".join(step.agents), step.action, step.cost) for step in self.plan or ())
        return Table(_COLUMNS, rows)

    def says(self, part: str) -> bool:
        """Whether it has a part, ``ties`` or ``goals`` for example, perhaps of another form."""
        return getattr(self, part) is not None or part in self.malformed

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only.

        Where the floats of its figures do not say it all, ``exact`` has texts in the same shape:
        ``{"cost": "10000000001/9999999999", "plan": {"0": {"cost": ...}}}``.
        """
        data = self._plain()
        texts = exact_texts(data)
        return data if texts is None else {**data, "exact": texts}

    def _plain(self) -> dict[str, Any]:
        plan = None if self.plan is None else [step.to_dict() for step in self.plan]
        return {
            "schema": SCHEMA,
            "version": self.version,
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
            "window": None if self.window is None else self.window.to_dict(),
            "reason": self.reason,
            "saving_alone": self.saving_alone,
            "plan": plan,
            "agent_costs": dict(self.agent_costs),
            "realised": dict(self.realised),
            "options": self.options.to_dict(),
            "statistics": {**self.statistics, **self._parts()},
            "policy": None if self.policy is None else self.policy.to_dict(),
        }

    def to_json(self) -> str:
        """The JSON text, as the command line writes it."""
        return json_of(self.to_dict())

    def told(self) -> Iterator[Line | Grid]:
        """What ``plan`` prints of it; without its task, which has a name, and may have more robots."""
        from serendipity.model.answers.words import told

        return told(self)

    def _in_short(self) -> Iterator[str]:
        """What stands between the brackets of its ``repr``."""
        yield repr(self.status)
        yield self.mode
        helped = f" -> {plain(self.cost)}" if self.opportunity else ""
        yield f"{self.human}: {plain(self.human_cost)}{helped}"
        if self.window is not None:
            yield f"window [{self.window.start}, {self.window.end})"

    def _parts(self) -> dict[str, Any]:
        """What stands in ``statistics`` in JSON beside the figures."""
        parts: dict[str, Any] = {}
        if self.gap is not None:
            parts["gap"] = [entry.to_dict() for entry in self.gap]
        if self.ties is not None:
            parts["ties"] = [answer.to_dict() for answer in self.ties]
        if self.optimal_plans is not None:
            parts["optimal_plans"] = self.optimal_plans
        if self.bounds is not None:
            parts["bounds"] = bounds_to_dict(self.bounds)
        if self.recognition is not None:
            parts["recognition"] = self.recognition.to_dict()
        if self.goals is not None:
            parts["goals"] = [goal.to_dict() for goal in self.goals]
        return parts

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


class _Reader(StepReader):
    """Reads a result object field by field, with one clear line for what is wrong."""

    def __init__(self, data: Any, file: object) -> None:
        super().__init__(file)
        if not isinstance(data, dict):
            raise self.error(f"expected a JSON object, got {type(data).__name__}")
        if fault := schema_fault(data.get("schema"), SCHEMA):
            raise self.error(fault)
        try:
            self.data = with_exact(data, data.get("exact", {}), "exact")
        except MalformedError as error:
            raise self.error(str(error)) from None

    def result(self) -> Result:
        options = self._options()
        status = self._text("status")
        if status not in STATUSES:
            raise self.error(f"status: expected one of {', '.join(STATUSES)}, got {status!r:.50}")
        mode = self._text("mode")
        if mode != options.mode:
            raise self.error(f"mode: is {mode!r:.50}, but '{options.mode}' in the options")
        parts, statistics, malformed = read_parts(self._mapping("statistics"))
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
            window=self.window(self._field("window")),
            reason=self._optional_text("reason"),
            saving_alone=self._number("saving_alone"),
            plan=self.plan(self._field("plan")),
            agent_costs=self._costs("agent_costs"),
            realised=self._verdicts("realised"),
            statistics=statistics,
            policy=self._policy(),
            malformed=malformed,
            version=self._optional_text("version") if "version" in self.data else None,
            **parts,
        )

    def _field(self, key: str) -> Any:
        if key not in self.data:
            raise self.error(f"the field '{key}' is missing")
        return self.data[key]

    def _text(self, key: str) -> str:
        value = self._field(key)
        if not isinstance(value, str):
            raise self.error(f"{key}: expected a text, got {value!r:.50}")
        return value

    def _optional_text(self, key: str) -> str | None:
        return None if self._field(key) is None else self._text(key)

    def _flag(self, key: str) -> bool:
        value = self._field(key)
        if not isinstance(value, bool):
            raise self.error(f"{key}: expected true or false, got {value!r:.50}")
        return value

    def _number(self, key: str, *, signed: bool = False) -> float | None:
        value = self._field(key)
        return None if value is None else self.finite(value, key, signed=signed)

    def _mapping(self, key: str) -> dict[str, Any]:
        value = self._field(key)
        if not isinstance(value, dict):
            raise self.error(f"{key}: expected an object, got {value!r:.50}")
        return value

    def _verdicts(self, key: str) -> dict[str, bool]:
        verdicts = self._mapping(key)
        if not all(isinstance(verdict, bool) for verdict in verdicts.values()):
            raise self.error(f"{key}: expected true or false for each human model")
        return verdicts

    def _costs(self, key: str) -> dict[str, float]:
        return {name: self.finite(cost, f"{key}.{name}") for name, cost in self._mapping(key).items()}

    def _names(self, key: str) -> tuple[str, ...] | None:
        value = self._field(key)
        if value is None:
            return None
        read = names(value)
        if read is None or not isinstance(value, list):
            raise self.error(f"{key}: expected a list of action names")
        return read

    def _options(self) -> Options:
        try:
            return Options.from_dict(self._mapping("options"))
        except UsageError as error:
            raise self.error(str(error)) from None

    def _horizon(self) -> Horizon | None:
        value = self._field("horizon")
        if value is None or value == "inf":
            return value  # type: ignore[no-any-return]
        return 0 if value == 0 and not isinstance(value, bool) else self.epoch(value, "horizon")

    def _policy(self) -> Policy | None:
        value = self.data.get("policy")  # only answers of mode assistance need to have one
        return None if value is None else Policy.from_dict(value, self.file)
