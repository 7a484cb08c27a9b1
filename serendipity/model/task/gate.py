"""The refusal of time where nothing knows it yet, all but plan: every such call comes by here."""

from typing import TYPE_CHECKING

from serendipity.model.errors import UsageError
from serendipity.model.options import Options
from serendipity.model.task.plans import TimedPlan

if TYPE_CHECKING:
    from serendipity.model.task.task import HumanPlan, Task


def refuse_time(
    task: "Task | None" = None, *, options: Options | None = None, plan: "HumanPlan | None" = None
) -> None:
    """Return if a call can do without time.

    Raises:
        UsageError: an action takes more than one epoch, there is a script, or the human waits in their plan.
    """
    if task is not None and task.needs_time:
        what = "the task has a script" if task.script else "the task has actions of more than one epoch"
    elif options is not None and (options.waiting_cost or options.head_start):
        what = "waiting_cost and head_start are given"
    elif isinstance(plan, TimedPlan):
        what = "the human waits in their plan"
    else:
        return
    raise UsageError(f"time: {what}, which is known to plan only, not here yet")
