"""``T``, the epochs in which everything has to happen: decided here for every mode (semantics 2, 3.5, 8)."""

from collections.abc import Iterable

from serendipity.model.errors import UsageError
from serendipity.model.keywords import Horizon
from serendipity.model.options import INFINITE, MAX_EPOCH, Options
from serendipity.model.task.task import HumanPlan, Task


def horizon_of(task: Task, options: Options, plan: HumanPlan | None) -> Horizon:
    """``T``: what the options say, else the length of ``pi_H``.

    Args:
        task: the task.
        options: in force.
        plan: ``pi_H``, or None where the human has no plan alone.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or one is missing; ``pi_H`` has too many actions.
    """
    _few_enough(len(plan or ()))
    if options.horizon is not None:
        replans = options.human_model != "omniscient"
        words = "the length of the human's plan" if replans else "as long as the human's plan"
        return _long_enough(options.horizon, 0 if plan is None else len(plan), words)
    if plan is None:
        if options.mode == "composite":
            return INFINITE
        raise UsageError("horizon: must be given, since the human has no plan alone")
    if not plan and not task.robot_goal.holds(task.init):
        raise UsageError(
            "horizon: must be given, since the human's goal holds already and robots have theirs"
        )
    return len(plan)


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


def _few_enough(actions: int) -> None:
    if actions > MAX_EPOCH:
        raise UsageError(f"horizon: expected at most {MAX_EPOCH} epochs, and the human's plan has {actions}")
