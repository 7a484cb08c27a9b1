"""The discount at which help begins to pay, and the window weight at which it ceases to: exact.

For one plan both the team's cost and the objective are linear in the discount, and no plan
gets dearer as it grows.  So the first discount that pays is found by going down: from the
answer at one discount to the discount at which that plan only breaks even, until no better
plan is left there (as Dinkelbach does for fractions).  The number of plans is finite.
"""

from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import Any, Final, NamedTuple

from serendipity.explanation.ask import Ask, cost_of, parts_of
from serendipity.facade.interruptibility import InterruptionReport

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
    alone = sum((cost_of(ask.task, name) for name in ask().human_plan or ()), Fraction(0))
    nothing = alone + (
        ask.options.window_weight if ask.options.windowed else 0
    )  # ``pi_H`` in its best window
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
