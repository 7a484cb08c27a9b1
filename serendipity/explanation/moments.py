"""Why this moment: the best plan for each start of the window, and what stops it."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from serendipity.facade.interruptibility import Interruption, InterruptionReport
from serendipity.model import Result, Window
from serendipity.model.answers.fields import Written
from serendipity.model.numbers import as_written

WHY: Final = {
    "chosen": "this is the answer",
    "as-good": "costs the team as much; the later start is preferred",
    "saves-less": "would save less",
    "not-in-time": "too early: robots can't be there in time",
    "costs-more": "would cost as much as it saves, or more",
    "prefix": "too late: by then the plan that is followed leaves nothing to save",
    "nothing": "no robot can make the human's plan cheaper",
}
"""What the reasons mean."""


@dataclass(frozen=True, slots=True)
class Moment(Written):
    """One start of the window.

    Attributes:
        start: ``xi1``.
        window: the best window that starts there.
        cost: least cost for the team in it, or None where no plan fits.
        why: a key of ``WHY``.
        instead: the nearest window from there that would help, if any.
        saving: what the team saves in ``instead`` (``not-in-time``), or the human does (``costs-more``).
    """

    start: int
    window: Window
    cost: Fraction | None
    why: str
    instead: Window | None = None
    saving: Fraction | None = None


def moments(report: InterruptionReport, answer: Result) -> tuple[Moment, ...]:
    """Each start, judged by the objective of the call that is explained."""
    weight = answer.options.window_weight
    starts: dict[int, list[Interruption]] = {}
    for entry in report.windows:
        starts.setdefault(entry.window.start, []).append(entry)
    return tuple(_moment(start, entries, report, answer, weight) for start, entries in sorted(starts.items()))


def _moment(
    start: int, entries: list[Interruption], report: InterruptionReport, answer: Result, weight: Fraction
) -> Moment:
    fitting = [entry for entry in entries if entry.team_cost is not None]
    if not fitting:
        return Moment(start, entries[0].window, None, "prefix")

    def order(entry: Interruption) -> tuple[Fraction, Fraction, int]:
        assert entry.team_cost is not None
        return entry.team_cost + weight * len(entry.window), entry.team_cost, len(entry.window)

    best = min(fitting, key=order)
    cost = best.team_cost
    if answer.window is not None and answer.window.start == start:
        return Moment(start, answer.window, cost, "chosen")
    if _positive(best.team_saving):
        as_good = answer.cost is not None and cost == as_written(answer.cost)
        return Moment(start, best.window, cost, "as-good" if as_good else "saves-less")
    later = next((entry for entry in fitting if _positive(entry.team_saving)), None)
    if later is not None:
        return Moment(start, best.window, cost, "not-in-time", later.window, later.team_saving)
    dear = next((entry for entry in fitting if _positive(entry.human_saving)), None)
    if dear is not None:
        return Moment(start, best.window, cost, "costs-more", dear.window, dear.human_saving)
    return Moment(start, best.window, cost, "prefix" if report.interruptible else "nothing")


def _positive(value: Fraction | None) -> bool:
    return value is not None and value > 0
