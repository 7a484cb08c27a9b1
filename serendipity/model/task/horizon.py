"""``T``, the epochs in which everything has to happen: decided here for every mode (semantics 2, 3.5, 8)."""

from collections.abc import Iterable
from typing import Final

from serendipity.model.errors import UsageError
from serendipity.model.keywords import Horizon
from serendipity.model.options import INFINITE, MAX_EPOCH, Options
from serendipity.model.task.plans_in_time import outlasts
from serendipity.model.task.task import HumanPlan, Task

MAX_DURATION: Final = 10_000
"""Epochs of an action that is planned for: an epoch of it is a fact and an action of its own."""

MAX_SCRIPT: Final = 100_000
"""Epochs of a script that is planned for."""


def require_few_epochs(task: Task) -> None:
    """A UsageError where an action or the script has more epochs than can be planned for."""
    longest = max(task.actions, key=lambda action: action.duration, default=None)
    if longest is not None and longest.duration > MAX_DURATION:
        raise UsageError(_too_long(f"'{longest.name}' takes", longest.duration, MAX_DURATION))
    if task.script.last > MAX_SCRIPT:
        raise UsageError(_too_long("the script takes", task.script.last, MAX_SCRIPT))


def _too_long(what: str, epochs: int, most: int) -> str:
    longer = "longer epochs can be asked for with --epoch"
    return f"time: {what} {epochs:,} epochs, expected at most {most:,}: {longer}"


def horizon_of(task: Task, options: Options, plan: HumanPlan | None) -> Horizon:
    """``T``: what the options say, else the length of ``pi_H`` in epochs.

    Args:
        plan: ``pi_H``, or None where the human has no plan alone.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or what that reaches does not last so long; one is
            missing; ``pi_H`` takes too many epochs.
    """
    length = 0 if plan is None else task.epochs_of(plan)
    _few_enough(length)
    if options.horizon is not None:
        replans = options.human_model != "omniscient"
        words = "the length of the human's plan" if replans else "as long as the human's plan"
        horizon = _long_enough(options.horizon, length, words)
        if plan is not None and task.script:
            _require_lasting(task, plan, horizon, strict=options.strict)
        return horizon
    if plan is None:
        if options.mode == "composite":
            return INFINITE
        raise UsageError("horizon: must be given, since the human has no plan alone")
    if not length and not task.robot_goal.holds(task.init):
        raise UsageError(
            "horizon: must be given, since the human's goal holds already and robots have theirs"
        )
    return length


def common_horizon(options: Options, plans: Iterable[HumanPlan]) -> int:
    """``T`` where the human's goal is not known: what the options say, else the length of the longest plan.

    Raises:
        UsageError: the horizon is shorter than that, or that is too long.
    """
    longest = max(map(len, plans))
    _few_enough(longest)
    if options.horizon is None:
        return longest
    return int(_long_enough(options.horizon, longest, "as long as the longest plan"))


def _long_enough(horizon: Horizon, least: int, words: str) -> Horizon:
    if isinstance(horizon, int) and horizon < least:
        raise UsageError(f"horizon: expected at least {least}, {words}, got {horizon}")
    return horizon


def _require_lasting(task: Task, plan: HumanPlan, horizon: Horizon, *, strict: bool) -> None:
    """Check that the goal holds at the end, and nobody is disturbed, where robots do nothing."""
    if isinstance(horizon, int):
        broken = outlasts(task, plan, horizon, strict=strict)
        if broken is not None:
            raise UsageError(f"horizon: the human's plan does not last until epoch {horizon}: {broken}")


def _few_enough(epochs: int) -> None:
    if epochs > MAX_EPOCH:
        raise UsageError(f"horizon: expected at most {MAX_EPOCH} epochs, and the human's plan has {epochs}")
