"""Planning calls that explanations rest on; when help begins to pay, and when it ceases to: exact.

For one plan both the team's cost and the objective are linear in the discount, and no plan
gets dearer as it grows.  So the first discount that pays is found by going down: from the
answer at one discount to the discount at which that plan only breaks even, until no better
plan is left there (as Dinkelbach does for fractions).  The number of plans is finite.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from fractions import Fraction
from math import inf
from typing import Any, Final, NamedTuple

from serendipity.facade.interruptibility import InterruptionReport
from serendipity.facade.planning import plan
from serendipity.model import Deadline, LimitReachedError, Options, Result, Task
from serendipity.model.numbers import as_written
from serendipity.model.task.plans import PlanEntry
from serendipity.model.task.plans_in_time import waited
from serendipity.model.task.task import canonical_name

PROVED: Final = ("optimal", "infeasible")
"""The statuses of answers that say how things are."""


class Ask:
    """Repeats one planning call with some options changed; equal calls are made once."""

    def __init__(
        self, task: Task, options: Options, human_plan: Sequence[PlanEntry] | None, deadline: Deadline
    ) -> None:
        self.task = task
        self.options = options
        self.human_plan = human_plan
        self.deadline = deadline
        self._answers: dict[Options, Result] = {}

    def __call__(self, **changes: Any) -> Result:
        """The proved answer under changed options, or a LimitReachedError."""
        answer = self.attempt(**changes)
        if answer.status not in PROVED:
            raise LimitReachedError(self.limit_of(answer))
        return answer

    def attempt(self, **changes: Any) -> Result:
        """The answer under changed options, proved or as far as the limit allows."""
        options = self.options.but(**changes)
        answer = self._answers.get(options)
        if answer is None:
            keywords = {field.name: getattr(options, field.name) for field in fields(options)}
            answer = plan(self.task, human_plan=self.human_plan, deadline=self.deadline, **keywords)
            self._answers[options] = answer
        return answer

    def limit_of(self, answer: Result) -> str:
        """Which limit kept an answer from being proved, as ``Result.reason`` has it."""
        if answer.reason is not None:
            return answer.reason
        # A call ends a little before its limit, and gives back what it took.
        likely = "memory-limit" if self.deadline.left() is None else "time-limit"
        return self.deadline.reached() or likely


@dataclass(frozen=True, slots=True)
class Parts:
    """What a composite plan costs, as a function of the discount.

    Attributes:
        human: undiscounted cost of what the human takes part in, waiting included.
        robots: undiscounted cost of everything else.
        announced: communication cost.
        length: epochs of the window, 0 without one.
        left: price of what is left changed.
    """

    human: Fraction
    robots: Fraction
    announced: Fraction
    length: int
    left: Fraction

    def discounted(self, options: Options) -> Fraction:
        """What the robots' part costs."""
        return (1 - options.discount) * self.robots

    def objective(self, options: Options) -> Fraction:
        """Cost, communication and window (semantics 3.1, 3.4)."""
        paid = self.human + self.discounted(options) + self.left
        return paid + self.announced + options.window_weight * self.length


def parts_of(task: Task, result: Result) -> Parts:
    """The parts of an answer's plan, exact whatever its discount."""
    former = set(result.human_plan or ())
    robots = announced = Fraction(0)
    begun = [(step.epoch, step.duration) for step in result.plan or () if result.human in step.agents]
    human = result.options.waiting_cost * waited(task, begun)
    for step in result.plan or ():
        cost = cost_of(task, step.action)
        if result.human not in step.agents:
            robots += cost
            continue
        human += cost
        if step.action not in former and result.options.mode == "communication":
            announced += cost * result.options.communication_weight
    left = Fraction(0)
    if result.options.leave_price is not None and result.cost is not None:
        left = as_written(result.cost) - human - (1 - result.options.discount) * robots
    return Parts(human, robots, announced, 0 if result.window is None else len(result.window), left)


def _alone(task: Task, result: Result) -> Fraction:
    """What the human pays alone."""
    names, times = result.human_plan or (), result.human_plan_times
    begun = () if times is None else zip(times.starts, times.durations, strict=True)
    waiting = result.options.waiting_cost * waited(task, begun)
    return sum((cost_of(task, name) for name in names), waiting)


def cost_of(task: Task, name: str) -> Fraction:
    """The undiscounted cost of the action of that name."""
    return task.actions[task.named[canonical_name(name)][0]].cost


STEP: Final = Fraction(1, 1000)
"""How far below and above a threshold the confirming calls are."""


class Confirmation(NamedTuple):
    """A planning call beside or at a threshold."""

    value: Fraction
    opportunity: bool
    cost: float | None


@dataclass(frozen=True, slots=True)
class Threshold:
    """Where an opportunity begins or ends.

    Attributes:
        option: ``discount`` (it exists above) or ``window_weight`` (it exists below).
        value: exact, or None: it exists nowhere.
        included: whether it exists at the value itself.
        confirmed: planning calls just below, at, and just above.
    """

    option: str
    value: Fraction | None
    included: bool
    confirmed: tuple[Confirmation, ...]

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; ``exact`` is the rational as a text."""
        return {
            "option": self.option,
            "value": None if self.value is None else float(self.value),
            "exact": None if self.value is None else str(self.value),
            "included": self.included,
            "confirmed": [{**c._asdict(), "value": float(c.value)} for c in self.confirmed],
        }


def discount_threshold(ask: Ask) -> Threshold:
    """The least discount from which on (or above which) a robot helps."""
    value, answer = Fraction(1), ask(discount=1)
    if not answer.opportunity:
        return Threshold("discount", None, False, (_confirm(ask, "discount", value),))
    alone = _alone(ask.task, ask())
    windowed = ask.options.windowed and ask.options.human_model == "omniscient"
    nothing = alone + (ask.options.window_weight if windowed else 0)  # ``pi_H`` in its best window
    while answer.opportunity:
        parts = parts_of(ask.task, answer)
        if parts.objective(answer.options) == nothing and value < 1:
            break  # a tie that the lower cost decides: it pays at this very discount, not below
        even = nothing - parts.objective(answer.options.but(discount=1))
        lower = Fraction(0) if not parts.robots else max(Fraction(0), 1 - even / parts.robots)
        if lower == value:
            break
        value = lower
        answer = ask(discount=value)
    return Threshold("discount", value, answer.opportunity, _confirmed(ask, "discount", value, most=1))


def window_weight_threshold(ask: Ask, report: InterruptionReport | None) -> Threshold:
    """The greatest ``K`` with which a robot helps in a window of two epochs or more."""
    assert report is not None, "there are windows where this is asked"
    values = [
        entry.team_saving / (len(entry.window) - 1)
        for entry in report.windows
        if len(entry.window) > 1 and entry.team_saving is not None and entry.team_saving > 0
    ]
    if not values:
        return Threshold("window_weight", None, False, (_confirm(ask, "window_weight", Fraction(0)),))
    value = max(values)
    confirmed = _confirmed(ask, "window_weight", value)
    included = next(c.opportunity for c in confirmed if c.value == value)
    return Threshold("window_weight", value, included, confirmed)


def _confirmed(ask: Ask, option: str, value: Fraction, most: float = inf) -> tuple[Confirmation, ...]:
    beside = (value - STEP, value, value + STEP)
    return tuple(_confirm(ask, option, each) for each in beside if 0 <= each <= most)


def _confirm(ask: Ask, option: str, value: Fraction) -> Confirmation:
    answer = ask(**{option: value})
    return Confirmation(value, answer.opportunity, answer.cost)
