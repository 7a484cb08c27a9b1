"""A right answer, doctored: figures and bounds that are made up, help that is denied."""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Any, Final

from serendipity.model import Result
from serendipity.model.numbers import as_written, figure
from serendipity_testing.crosscheck.other_tasks import TRIFLES

_NOT_THERE: Final = (
    *("plan", "policy", "window", "ties", "bounds"),
    *("cost", "objective", "lower_bound", "saving", "saving_alone"),
)
_REASONS: Final = ("no-human-plan", "no-plan", "no-plan-within-horizon")


def without_plan(result: Result, status: str, reason: str | None, bound: float | None = None) -> Result:
    """The same call, answered that there is no plan, or that none is known yet."""
    nothing: dict[str, Any] = dict.fromkeys(_NOT_THERE)
    nothing |= {"status": status, "reason": reason, "lower_bound": bound, "opportunity": False}
    return replace(result, agent_costs={}, realised={}, **nothing)


def doctored(right: Result, denied: Result | None, dice: Random) -> Iterator[tuple[str, Result]]:
    """Kinds and results.

    Args:
        right: an answer.
        denied: the same call, answered that nothing helps.
    """
    yield from (("said to be infeasible", without_plan(right, "infeasible", reason)) for reason in _REASONS)
    if right.cost is None or right.objective is None:
        return
    if denied is not None:
        yield from (("help denied", replace(denied, status=status)) for status in ("optimal", "feasible"))
    yield from (("a higher bound", made) for made in _bounds(right, denied or right, dice))
    yield from (("other figures", made) for made in _figures(right, dice))


def _bounds(right: Result, denied: Result, dice: Random) -> Iterator[Result]:
    for base in (right, denied):
        least = as_written(base.objective or 0.0)
        for trifle in dice.sample(TRIFLES, 2):
            above = figure(least + trifle * max(1, int(least)))
            yield replace(base, status="feasible", lower_bound=above)
            yield replace(base, status="feasible", lower_bound=above, objective=above)
            yield without_plan(base, "unknown", "time-limit", above)


def _figures(right: Result, dice: Random) -> Iterator[Result]:
    for trifle in dice.sample(TRIFLES, 3):
        more = trifle * dice.choice((1, max(1, int(right.objective or 0)))) * dice.choice((-1, -1, 1))
        yield _moved(right, more)
        name = dice.choice(("cost", "objective", "saving", "saving_alone", "human_cost"))
        named: dict[str, Any] = {name: _plus(getattr(right, name), more)}
        yield replace(right, **named)


def _plus(said: float | None, more: Fraction) -> float:
    return figure(abs(as_written(said or 0.0) + more))


def _moved(right: Result, more: Fraction) -> Result:
    """The same at another cost, all figures following it."""
    figures: dict[str, Any] = {
        name: _plus(getattr(right, name), more) for name in ("cost", "objective", "lower_bound")
    }
    return replace(right, **figures, saving=_plus(right.saving, -more))
