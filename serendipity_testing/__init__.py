"""The kit that planners are tested with: ours, and yours.

Everything public is importable from here and loads when it is first used; what draws at random with
hypothesis needs the extra ``testing``::

    from serendipity.testing import best, check_planner, task, tasks

``pytest --serendipity-planner package.module:function`` checks a planner of yours.
"""

TYPE_CHECKING = False  # of `typing`, which a plugin that nobody asked for need not load

if TYPE_CHECKING:
    from typing import Any

    from serendipity_testing.builders import task, usar
    from serendipity_testing.by_hand import result
    from serendipity_testing.call import Call
    from serendipity_testing.cases import WORKED, Worked
    from serendipity_testing.generator import PlanCall, family_task, random_call, random_task
    from serendipity_testing.judges import Answer, by_command, by_function, by_name
    from serendipity_testing.laws import LAWS
    from serendipity_testing.oracle import Optimum, best, human_plans, optimal_human_plan
    from serendipity_testing.reporting import PlannerError, check_planner
    from serendipity_testing.shrinking import shrink
    from serendipity_testing.strategies import (
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
    "builders": "task usar",
    "by_hand": "result",
    "call": "Call",
    "cases": "WORKED Worked",
    "generator": "PlanCall family_task random_call random_task",
    "judges": "Answer by_command by_function by_name",
    "laws": "LAWS",
    "oracle": "Optimum best human_plans optimal_human_plan",
    "reporting": "PlannerError check_planner",
    "shrinking": "shrink",
    "strategies": "calls corridor_tasks errand_tasks family_tasks oddly_priced_tasks options plans results "
    "strips_tasks tasks usar_tasks",
}
"""The modules of the public names."""

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
    home = next((home for home, names in _HOMES.items() if name in names.split()), None)
    if home is None:
        raise AttributeError(f"module 'serendipity.testing' has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(f"serendipity_testing.{home}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
