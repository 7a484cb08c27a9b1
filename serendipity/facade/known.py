"""What a session knows of one question, also as plain values for another process."""

from collections.abc import Hashable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final, NamedTuple

from search import WarmStart
from serendipity.model import Options, Step, Task, UsageError, Visible, Window
from serendipity.model.answers.answer import Answer
from serendipity.model.arguments import FLAG, expect, shown
from serendipity.model.numbers import MOST_IN_RESULTS, exact
from serendipity.model.options import INFINITE, MAX_EPOCH
from serendipity.model.task.plans import PlanEntry, checked_entries


class Known(NamedTuple):
    """Knowledge of one question.

    Attributes:
        options: as they were asked for, with the limits of the last call.
        answer: the last answer; None once the world has moved on.
        warm: what a search may begin with.
        human_plan: what is left, as it is given, of the human's plan that it is about; None: of none.
        visible: what the human sees, if the caller has said it.
    """

    options: Options
    answer: Answer | None
    warm: WarmStart
    human_plan: tuple[PlanEntry, ...] | None
    visible: Visible | None


_NO_MORE: Final = 10**9
"""Actions of a task, at most."""


def whole(what: str, value: object, *, least: int = 0, most: int = MAX_EPOCH) -> int:
    """A whole number within its bounds, by default those of epochs.

    Raises:
        UsageError: it is no whole number, or too small or too large.
    """
    if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
        raise UsageError(f"{what}: expected a whole number from {least} to {most}, got {shown(value)}")
    return value


def written(task: Task, about: Hashable, known: Known) -> dict[str, Any]:
    """Knowledge as plain values.

    Args:
        about: what its question is about, where goals are not known.  Only what is left of it is written.
    """
    warm = known.warm
    if known.visible is not None:  # a function, and what is proved holds for what they see only
        warm = replace(warm, bound=None, is_best=False)
    return {
        "options": known.options.to_dict(),
        **({} if about is None else {"unsure": True}),
        "human_plan": known.human_plan,
        "steps": [[step.epoch, step.action] for step in warm.steps],
        "names": [task.actions[step.action].name for step in warm.steps],
        "window": None if warm.window is None else warm.window.to_dict(),
        "is_sure": warm.is_sure,
        "bound": _text(warm.bound),
        "is_best": warm.is_best,
        "horizon": warm.horizon if warm.horizon == INFINITE else _near(warm.horizon),
    }


def read(task: Task, value: Mapping[str, Any]) -> tuple[bool, Known]:
    """What :func:`written` has told, from the same state; first whether its question was about other goals.

    Raises:
        KeyError, TypeError, ValueError, UsageError: it has told nothing of the kind.
    """
    plan, unsure = value["human_plan"], value.get("unsure", False)
    expect(FLAG, unsure=unsure)
    his = None if plan is None else checked_entries(plan, "human plan")
    return unsure, Known(Options.from_dict(value["options"]), None, _read(task, value), his, None)


def _read(task: Task, value: Mapping[str, Any]) -> WarmStart:
    steps = tuple(
        Step(whole("epoch", epoch, least=1), whole("action", action, most=_NO_MORE))
        for epoch, action in value["steps"]
    )
    ends, bound, horizon = value["window"], value["bound"], value["horizon"]
    is_sure, is_best = value["is_sure"], value["is_best"]
    expect(FLAG, is_sure=is_sure, is_best=is_best)
    found = WarmStart(
        steps,
        None if ends is None else _window(ends),
        is_sure,
        None if bound is None else exact(bound, "bound", MOST_IN_RESULTS),
        is_best,
        horizon if horizon in (None, INFINITE) else whole("horizon", horizon, least=-MAX_EPOCH),
    )
    names = [task.actions[step.action].name for step in steps if step.action < len(task.actions)]
    return found if names == value["names"] else WarmStart()  # the task was read otherwise


def _window(ends: Mapping[str, Any]) -> Window:
    """A window, which may end with the last epoch that there is."""
    return Window(*(whole(end, ends[end], least=1, most=MAX_EPOCH + 1) for end in ("start", "end")))


def _text(bound: Fraction | None) -> str | None:
    """A bound as text; None as well where nobody would read it."""
    if bound is None or max(abs(bound.numerator), bound.denominator) >= 10 ** (MOST_IN_RESULTS // 2 - 1):
        return None
    return str(bound)


def _near(horizon: int | str | None) -> int | None:
    """A horizon, which is less than none once it has passed."""
    return max(horizon, -MAX_EPOCH) if isinstance(horizon, int) else None
