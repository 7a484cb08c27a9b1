"""The refusal of time where nothing knows it yet: every such call comes by here."""

from typing import TYPE_CHECKING

from serendipity.model.errors import UsageError
from serendipity.model.options import Options
from serendipity.model.task.plans import PlanTimes, TimedPlan

if TYPE_CHECKING:
    from serendipity.model.task.task import HumanPlan, Task


def needs_time(
    task: "Task | None" = None,
    *,
    options: Options | None = None,
    plan: "HumanPlan | PlanTimes | None" = None,
) -> str | None:
    """The reason why a call can't do without time, in words; None where it can."""
    if task is not None and task.needs_time:
        return "the task has a script" if task.script else "the task has actions of more than one epoch"
    if options is not None and (options.waiting_cost or options.head_start):
        return "waiting_cost and head_start are given"
    return "the human waits in their plan" if isinstance(plan, TimedPlan | PlanTimes) else None


def refuse_time(
    task: "Task | None" = None,
    *,
    options: Options | None = None,
    plan: "HumanPlan | PlanTimes | None" = None,
) -> None:
    """Return if a call can do without time.

    Raises:
        UsageError: it can't.
    """
    what = needs_time(task, options=options, plan=plan)
    if what is not None:
        raise UsageError(f"time: {what}, which is not known here yet")
