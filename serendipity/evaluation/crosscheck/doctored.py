"""A right answer, doctored: figures, bounds, ties and policies that are made up."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from random import Random
from statistics import mean
from typing import Any, Final

from serendipity.evaluation.crosscheck.other_tasks import TRIFLES
from serendipity.model import Result
from serendipity.model.numbers import as_written, figure

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
    yield from (("other ties", made) for made in _ties(right, dice))
    yield from (("another policy", made) for made in _policies(right, dice))


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


def _moved(right: Result, more: Fraction, **fields: Any) -> Result:
    """The same at another cost, all figures following it."""
    figures = {name: _plus(getattr(right, name), more) for name in ("cost", "objective", "lower_bound")}
    return replace(right, **{**figures, "saving": _plus(right.saving, -more), **fields})


def _ties(right: Result, dice: Random) -> Iterator[Result]:
    """Answers over ties some of which are left out, written down twice, or made up."""
    if not right.ties:
        return
    listed, alone = list(right.ties), float(right.human_cost or 0)
    cheapest = min(listed, key=lambda tie: tie.cost or 0)
    lists = [
        listed[1:],
        listed[:1] * 2,
        [cheapest] * 2,
        [replace(dice.choice(listed), cost=alone, opportunity=False) for _ in listed],
        [replace(tie, cost=(tie.cost or 0) / 2, opportunity=True) for tie in listed],
    ]
    over: dict[str, Callable[[list[Fraction]], Fraction]] = {
        "robust": max,
        "optimistic": min,
        "expected": mean,
    }
    for ties in filter(None, lists):
        cost = over[right.options.ties]([as_written(tie.cost or 0.0) for tie in ties])
        made = _moved(right, cost - as_written(right.cost or 0.0), ties=tuple(ties))
        yield made
        yield replace(made, status="feasible", lower_bound=0.0)


def _policies(right: Result, dice: Random) -> Iterator[Result]:
    """Policies said to be worth less or more, with values and floors that follow, or don't."""
    policy, bounds = right.policy, right.bounds
    if policy is None or bounds is None or bounds.upper is None:
        return
    trifle, (first, second) = dice.choice(TRIFLES), bounds.upper
    for worth in (
        (max(Fraction(0), first - trifle), second),
        (first + trifle, second),
        (first, second + trifle),
    ):
        moved = tuple(replace(d, value=(d.value[0] + worth[0] - first, d.value[1])) for d in policy.decisions)
        for decisions in (policy.decisions, moved, ()):
            for floors in (policy.floors, tuple(replace(f, value=worth) for f in policy.floors or ())):
                yield _moved(
                    right,
                    sum(worth, Fraction(0)) - first - second,
                    policy=replace(policy, decisions=decisions, floors=floors),
                    bounds=replace(bounds, lower=worth, upper=worth),
                    agent_costs=dict(zip(right.agent_costs, map(figure, worth), strict=True)),
                    saving=None if right.saving is None else _plus(right.saving, first - worth[0]),
                )
