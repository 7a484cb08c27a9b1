"""What planners are tested with: ours, and yours.

Everything public is importable from here and loads when it is first used; what draws at random with
hypothesis needs the extra ``testing``::

    from serendipity.testing import best, check_planner, task, tasks

``pytest --serendipity-planner package.module:function`` checks a planner of yours.
"""

TYPE_CHECKING = False  # of `typing`, which a plugin that nobody asked for need not load

if TYPE_CHECKING:
    from typing import Any

    from serendipity.testing.builders import task, usar
    from serendipity.testing.by_hand import result
    from serendipity.testing.call import Call
    from serendipity.testing.cases import WORKED, Worked
    from serendipity.testing.generator import PlanCall, family_task, random_call, random_task
    from serendipity.testing.judges import Answer, by_command, by_function, by_name
    from serendipity.testing.laws import LAWS
    from serendipity.testing.oracle import Optimum, best, human_plans, optimal_human_plan
    from serendipity.testing.reporting import PlannerError, check_planner
    from serendipity.testing.shrinking import shrink
    from serendipity.testing.strategies import (
        calls,
        corridor_tasks,
        errand_tasks,
        family_tasks,
        oddly_priced_tasks,
        options,
        plans,
        results,
        strips_tasks,
        tasks,
        usar_tasks,
    )

_HOMES = {
    "Answer": "judges",
    "Call": "call",
    "LAWS": "laws",
    "Optimum": "oracle",
    "PlanCall": "generator",
    "PlannerError": "reporting",
    "WORKED": "cases",
    "Worked": "cases",
    "best": "oracle",
    "by_command": "judges",
    "by_function": "judges",
    "by_name": "judges",
    "calls": "strategies",
    "check_planner": "reporting",
    "corridor_tasks": "strategies",
    "errand_tasks": "strategies",
    "family_task": "generator",
    "family_tasks": "strategies",
    "human_plans": "oracle",
    "oddly_priced_tasks": "strategies",
    "optimal_human_plan": "oracle",
    "options": "strategies",
    "plans": "strategies",
    "random_call": "generator",
    "random_task": "generator",
    "result": "by_hand",
    "results": "strategies",
    "shrink": "shrinking",
    "strips_tasks": "strategies",
    "task": "builders",
    "tasks": "strategies",
    "usar": "builders",
    "usar_tasks": "strategies",
}
"""The modules in which the public names live."""

__all__ = [
    "LAWS",
    "WORKED",
    "Answer",
    "Call",
    "Optimum",
    "PlanCall",
    "PlannerError",
    "Worked",
    "best",
    "by_command",
    "by_function",
    "by_name",
    "calls",
    "check_planner",
    "corridor_tasks",
    "errand_tasks",
    "family_task",
    "family_tasks",
    "human_plans",
    "oddly_priced_tasks",
    "optimal_human_plan",
    "options",
    "plans",
    "random_call",
    "random_task",
    "result",
    "results",
    "shrink",
    "strips_tasks",
    "task",
    "tasks",
    "usar",
    "usar_tasks",
]


def __getattr__(name: str) -> "Any":
    if name not in _HOMES:
        raise AttributeError(f"module 'serendipity.testing' has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(f"serendipity.testing.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})
