"""The answer to a planning call: in JSON (schema ``serendipity.result/1``), and in words for people."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, fields, replace
from fractions import Fraction
from itertools import chain
from typing import Any, Final

from serendipity._version import __version__
from serendipity.model.answers.answer import PolicyBounds, Status
from serendipity.model.answers.fields import MalformedError, finite, form
from serendipity.model.answers.over_scenarios import over_scenarios, rule_told
from serendipity.model.answers.policy import Policy
from serendipity.model.answers.recognition import Recognition
from serendipity.model.answers.result_form import FORMS, fields_of, object_of
from serendipity.model.answers.result_parts import GapEntry, GoalAnswer, HelpedPerson, TiedAnswer
from serendipity.model.errors import InputError
from serendipity.model.keywords import Horizon, Mode
from serendipity.model.numbers import as_written, plain, plain_seconds
from serendipity.model.options import Options
from serendipity.model.table import Table, Tabular
from serendipity.model.task.plans import PlanEntry, PlanStep, PlanTimes, Window
from serendipity.model.telling import Grid, Line, Output, counted, team

_COLUMNS: Final = {"epoch": int, "agents": str, "action": str, "cost": float, "duration": int}

_REASONS: Final = {
    "no-human-plan": "the human can't reach the goal alone, so there is no plan to preserve",
    "no-plan": "no plan reaches the goals within the horizon",
}
"""The commonest reasons of an infeasible result, in words."""


@dataclass(frozen=True, slots=True, repr=False)
class Result(Tabular, Output):
    """The answer of ``plan``; fields as in ``docs/reference`` (costs in the domain's unit).

    ``status``: ``optimal`` (proved), ``feasible`` (a plan; the limit came first),
    ``infeasible`` (proved; ``reason`` says why) or ``unknown`` (the limit came first).

    ``statistics`` has figures of the call.  What only some answers have is typed, None elsewhere, and
    stands in ``statistics`` in JSON only: ``ties`` (the answers for single optimal plans of the human)
    and ``optimal_plans`` (how many there are), ``goals`` and ``recognition`` (where their goal is not
    known), ``bounds`` (mode ``assistance``), ``gap`` (how the answer got better), ``humans`` (of each whom it
    could help, with ``human="any"``).  A part of a file that
    is of another form stays in ``statistics``, and ``malformed`` says what is wrong with it.

    ``human_plan_times`` says when the human's actions begin, where these take several epochs or the human
    waits; None: one after another.  ``bystanders`` are the plans of these, by name (semantics 10.3).

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
    human_plan_times: PlanTimes | None = None
    bystanders: dict[str, tuple[PlanStep, ...]] = field(default_factory=dict)
    humans: tuple[HelpedPerson, ...] | None = None

    @property
    def human_entries(self) -> tuple[PlanEntry, ...] | None:
        """The human's plan as :func:`serendipity.plan` takes it: names, with their epochs where it has times.

        A head start is part of it.
        """
        times, names = self.human_plan_times, self.human_plan
        return names if times is None or names is None else times.entries(names)

    @property
    def in_time(self) -> bool:
        """Whether it says more of times than which epoch each action is for."""
        every: tuple[Result | GoalAnswer, ...] = (self, *(self.goals or ()))
        longer = any(step.duration > 1 for said in every for step in said.plan or ())
        return longer or any(said.human_plan_times for said in every) or bool(self.bystanders)

    def figure(self, name: str) -> int | float | None:
        """A number of the statistics; None where there is none of that name."""
        value = self.statistics.get(name)
        return None if finite(value) is None else value

    def table(self) -> Table:
        """The plan, a step a row; no row without a plan."""
        rows = tuple(
            (step.epoch, ", ".join(step.agents), step.action, step.cost, step.duration)
            for step in self.plan or ()
        )
        return Table(_COLUMNS, rows)

    def says(self, part: str) -> bool:
        """Whether it has a part, ``ties`` or ``goals`` for example, perhaps of another form."""
        return getattr(self, part) is not None or part in self.malformed

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only.

        Where the floats of its figures do not say it all, ``exact`` has texts in the same shape:
        ``{"cost": "10000000001/9999999999", "plan": {"0": {"cost": ...}}}``.
        """
        return object_of(self)

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``plan`` prints, but for what only its task knows: its name, and more robots."""
        robots = _robots(self)
        if self.goals is not None:
            yield from over_scenarios(self)
            return
        yield Line(team(self.human, robots))
        yield from opening(self, robots)
        if self.policy is not None and self.plan is None:
            yield from (Line(), *self.policy.told(), Line())
        yield from map(Line, closing(self))

    def _in_short(self) -> Iterator[str]:
        yield repr(self.status)
        yield self.mode
        helped = f" -> {plain(self.cost)}" if self.opportunity else ""
        yield f"{self.human}: {plain(self.human_cost)}{helped}"
        if self.window is not None:
            yield f"window [{self.window.start}, {self.window.end})"

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
        try:
            return cls(**fields_of(cls, data))
        except MalformedError as error:
            raise InputError(f"result: {error}", file) from None

    def checked(self) -> "Result":
        """This result as its JSON would be read: for results that somebody made by hand.

        Raises:
            InputError: a field has a type or a value that no result has.
        """
        try:
            data = self.to_dict()
        except (AttributeError, TypeError, ValueError) as error:
            raise InputError(f"result: a field is of another type: {error}") from None
        return replace(Result.from_dict(data), options=self.options)


form(Result, FORMS)


def _robots(result: Result) -> list[str]:
    """The robots that a result names."""
    named = [*result.agent_costs, *(agent for step in result.plan or () for agent in step.agents)]
    return [agent for agent in dict.fromkeys(named) if agent not in (result.human, *result.bystanders)]


def opening(result: Result, robots: Sequence[str]) -> Iterator[Line | Grid]:
    """The headlines of an answer, and the plan in parallel columns."""
    yield from map(Line, headlines(result))
    if result.window is not None:
        last = result.window.end - 1
        epochs = f"epoch {last}" if len(result.window) == 1 else f"epochs {result.window.start} to {last}"
        who = result.human
        phases = f"before it {who} follows the former plan, after it {who} goes on alone"
        yield Line(f"window: {epochs} (marked *); {phases}")
    if result.plan is not None and (result.plan or result.human_plan):
        yield from (Line(), _columns(result, robots), Line())


def headlines(result: Result) -> Iterator[str]:
    """The call and its answer in a line, and what that costs."""
    yield f"{', '.join(_options(result.options))}: {_summary(result)}"
    if result.human_plan == ():
        yield f"{result.human}'s goal holds already, so there is nothing to help {result.human} with"
    if result.mode == "assistance" and result.agent_costs:
        yield _totals(result)
    elif result.cost is not None and result.human_cost is not None:
        yield _costs(result.human_cost, result.cost, result.saving if result.opportunity else None)
    elif result.cost is not None:
        yield f"cost {plain(result.cost)}"
    yield from rule_told(result)


def _costs(before: float, after: float, saving: float | None) -> str:
    """The costs without and with help, with as many digits as tell them apart."""
    figures = plain(before), plain(after)
    if saving and figures[0] == figures[1]:
        figures = f"{before:.17g}", f"{after:.17g}"
    if saving and figures[0] == figures[1]:
        return f"cost {plain(before)}, saving {plain(saving)}"
    return f"cost {figures[0]} -> {figures[1]}{f', saving {plain(saving)}' if saving else ''}"


def _options(options: Options) -> Iterator[str]:
    """The mode, and every option that is not the default."""
    usual = Options()
    yield options.mode
    for option in fields(Options):
        value = getattr(options, option.name)
        if option.name != "mode" and value != getattr(usual, option.name):
            shown = plain(value) if isinstance(value, Fraction | float) else str(value)
            yield f"{option.name} {shown}"


def _summary(result: Result) -> str:
    by = f" by {result.statistics['proved_by']}" if "proved_by" in result.statistics else ""
    if result.status == "infeasible":
        return f"infeasible (proved{by}): {_REASONS.get(result.reason or '', result.reason or 'no plan')}"
    if result.status == "unknown":
        return f"{'interrupted' if result.reason == 'cancelled' else 'the limit came'} before any answer"
    proof = f"proved to be the best{by}" if result.status == "optimal" else _gap(result)
    if result.opportunity:
        return f"an opportunity, {proof}"
    if result.mode in ("serendipity", "communication"):
        return f"no opportunity, {proof}" if result.status == "feasible" else "no opportunity (proved)"
    return f"a plan, {proof}"


def _gap(result: Result) -> str:
    known = f": {_least_cost(result)}" if result.lower_bound else ""
    return f"not proved to be the best{known}"


def _least_cost(result: Result) -> str:
    """The lower bound of an unproved answer as a bound on costs: without the price of the window itself."""
    assert result.lower_bound is not None
    bound, weight = as_written(result.lower_bound), result.options.window_weight
    paid = "paid, announcements included" if result.options.communication_weight else "paid"
    if result.window is None or not result.options.windowed:
        return f"at least {plain(bound)} has to be {paid}"
    if weight <= (result.human_cost or 0):  # costs may outweigh windows: no figure without both
        return f"no less than {plain(bound)} is possible, with {plain(weight)} for each epoch of a window"
    epochs = max(1, min(int(bound / weight), len(result.window)))
    least = plain(max(bound - epochs * weight, Fraction(0)))
    if epochs == len(result.window):
        return f"at least {least} has to be {paid}"
    return f"in a window of {epochs} epoch{'s' if epochs > 1 else ''}, at least {least} has to be {paid}"


def _columns(result: Result, robots: Sequence[str]) -> Grid:
    """Epochs down, agents across; a joint action stands in each participant's column.

    In time they stand where they begin, with their lengths, and epochs in which nothing begins are left out.
    """
    agents = [result.human, *robots, *result.bystanders]
    plan = [*(result.plan or ()), *chain.from_iterable(result.bystanders.values())]
    steps = {(step.epoch, agent): _cell(step.action, step.duration) for step in plan for agent in step.agents}
    former, changed = _former(result), _changed(result)
    inside = range(0) if result.window is None else range(result.window.start, result.window.end)
    begun = {epoch for epoch, _ in steps} | {*former}
    epochs: Sequence[int] = range(1, max(begun, default=0) + 1)
    if result.in_time:
        epochs = sorted({*begun, *inside[:1], *inside[-1:]})
    rows = []
    for epoch in epochs:
        row = [f"{'* ' if epoch in inside else ''}{epoch}", *(steps.get((epoch, a), "") for a in agents)]
        rows.append([*row, former.get(epoch, "")] if changed and epoch <= max(former, default=0) else row)
    costs = ["cost", *(plain(result.agent_costs[a]) if a in result.agent_costs else "" for a in agents)]
    if changed and result.human_cost is not None:
        costs.append(plain(result.human_cost))
    header = [
        "epoch",
        *(f"{a} (bystander)" if a in result.bystanders else a for a in agents),
        *([f"{result.human}'s former plan"] if changed else []),
    ]
    marked = frozenset(row for row, epoch in enumerate(epochs) if epoch in inside)
    return Grid(header, [*rows, costs], marked, numbered=True)


def _cell(action: str, duration: int) -> str:
    return action if duration == 1 else f"{action} [{duration}]"


def _former(result: Result) -> dict[int, str]:
    """What the human's plan begins, by epoch."""
    names, times = result.human_plan or (), result.human_plan_times
    if times is None:
        return dict(enumerate(names, start=1))
    return dict(zip(times.starts, map(_cell, names, times.durations), strict=True))


def _changed(result: Result) -> bool:
    """Whether the human does something else than their plan, or at another time, which only times tell."""
    theirs = [step for step in result.plan or () if result.human in step.agents]
    if result.human_plan_times is None:
        return tuple(step.action for step in theirs) != (result.human_plan or ())
    return {step.epoch: _cell(step.action, step.duration) for step in theirs} != _former(result)


def closing(result: Result) -> Iterator[str]:
    """The last lines of an answer: ties, verdicts on humans who replan, time."""
    if result.saving_alone:
        yield f"{result.human} could save {plain(result.saving_alone)} alone: the given plan is not the best"
    elif _may_be_dear(result):
        yield f"{result.human} may have a cheaper plan alone: this one is not proved to be the best"
    if result.ties and result.optimal_plans is None:
        yield f"no other plan of the human's was looked at ({result.options.ties})"
    elif result.ties:
        helped = sum(tie.opportunity for tie in result.ties)
        many, looked_at = result.optimal_plans, len(result.ties)
        some = "" if looked_at == many else f", {looked_at} looked at"
        plans = counted(many or 0, "optimal plan")
        yield f"{plans} of the human{some}, an opportunity with {helped} ({result.options.ties})"
    if result.humans:
        saved = ", ".join(f"{one.human} {plain(one.saving)}" for one in result.humans)
        yield f"{result.human} is helped, as whoever saves most: {saved}"
    for model, realised in sorted(result.realised.items()):
        article = "an" if model[0] in "aeiou" else "a"
        yield f"with {article} {model} human the plan {'works out' if realised else 'does not work out'}"
    elapsed, expanded = result.figure("elapsed_seconds"), result.figure("expanded")
    if elapsed is not None:
        yield f"planned in {plain_seconds(elapsed)}" + (f", {expanded} nodes expanded" if expanded else "")


def _may_be_dear(result: Result) -> bool:
    """Whether it is not known what the human could save alone, though nobody's goals stand against that."""
    compared = result.human_plan is not None and result.saving is not None and result.mode != "individual"
    return compared and result.status == "feasible" and result.saving_alone is None


def _totals(result: Result) -> str:
    """Both totals of semantics 7, and what the human pays alone."""
    unknown = result.status == "feasible" and result.human_plan is None  # what the human pays alone
    idle = result.plan is None and result.policy is not None and not result.policy.decisions
    pays = "pays at most" if unknown and idle else "pays"
    paid = ", ".join(f"{agent} {pays} {plain(cost)}" for agent, cost in result.agent_costs.items())
    mean = " on average" if result.options.ties == "expected" else ""
    alone = "" if result.human_cost is None else f"; alone {result.human} pays {plain(result.human_cost)}"
    return f"{paid}{mean}{alone}"
