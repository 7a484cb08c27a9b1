"""What a call asks for: time, refused where nothing knows it yet, and help that costs nobody anything."""

from typing import TYPE_CHECKING, Final

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
    """A UsageError where a call can't do without time."""
    what = needs_time(task, options=options, plan=plan)
    if what is not None:
        raise UsageError(f"time: {what}, which is not known here yet")


def nobody_pays(task: "Task", options: Options) -> bool:
    """Whether help may cost nobody anything (semantics 12) in a task as given: by default with bystanders."""
    asked = options.nobody_pays
    if asked is None:
        asked = bool(task.script.people) and options.human_model == "omniscient"
    return asked and options.mode not in ("individual", "assistance")


def is_bound(task: "Task", options: Options) -> bool:
    """Whether help has to leave anything as it would be without it."""
    names = ("leave_free", "leave_price", "disturbance", "max_disturbance")
    limited = options.noticed or any(getattr(options, name) is not None for name in names)
    return (limited and options.mode not in ("individual", "assistance")) or nobody_pays(task, options)


_METERED: Final[dict[str, object]] = {"suffix": "replan", "preservation": "kernel", "waiting_cost": 0}
"""Options that have one value where what the human pays is metered: a plan's actions change with it."""


def require_metered(task: "Task", options: Options, *, scenarios: int = 1) -> None:
    """A UsageError where help can't be bound as it is asked for (semantics 12 to 14)."""
    if options.leave_price is not None and task.robot_goal:
        raise UsageError("leave_price: is for robots without goals of their own")
    if not nobody_pays(task, options) or (not task.robot_goal and scenarios == 1):
        return
    for name, value in _METERED.items():
        if getattr(options, name) != value:
            raise UsageError(
                "nobody_pays: with robots' goals of their own, or several goals or plans, it goes with "
                f"{name} {value} only; nobody_pays=False (--somebody-pays) leaves it out"
            )
