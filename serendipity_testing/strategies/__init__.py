"""Hypothesis strategies (extra ``testing``) for small tasks and planning calls; they only build.

Everything is built by construction, nothing is filtered.  The oracle answers a
typical call in some ten milliseconds.

    @given(calls())
    def test_law(call: Call) -> None:
        optimum = best(call.task, call.options, call.human_plan)
"""

try:
    import hypothesis  # noqa: F401  # the library is an extra: say so where it is missing
except ImportError as error:
    raise ImportError(
        "serendipity.testing.strategies needs hypothesis: install the extra, serendipity-planner[testing]",
        name=error.name,
    ) from None

from serendipity_testing.call import Call
from serendipity_testing.strategies.calls import MODES, calls, calls_among_people, options, plans, results
from serendipity_testing.strategies.tasks import (
    corridor_tasks,
    errand_tasks,
    family_tasks,
    oddly_priced_tasks,
    strips_tasks,
    tasks,
    usar_tasks,
)
from serendipity_testing.strategies.time import (
    bystander_tasks,
    calls_in_time,
    scripted_tasks,
    scripts,
    tasks_in_time,
    timed_plans,
    timed_tasks,
)

__all__ = [
    "MODES",
    "Call",
    "bystander_tasks",
    "calls",
    "calls_among_people",
    "calls_in_time",
    "corridor_tasks",
    "errand_tasks",
    "family_tasks",
    "oddly_priced_tasks",
    "options",
    "plans",
    "results",
    "scripted_tasks",
    "scripts",
    "strips_tasks",
    "tasks",
    "tasks_in_time",
    "timed_plans",
    "timed_tasks",
    "usar_tasks",
]
