"""Serendipity for those who plan with unified-planning (extra ``up``).

Importing this registers the engine ``serendipity``::

    import serendipity.up
    from unified_planning.shortcuts import OneshotPlanner

    with OneshotPlanner(name="serendipity", params={"mode": "serendipity", "human": "ann"}) as planner:
        print(planner.solve(problem).plan)

What of a problem is not supported is an ``InputError``, an agent, plan or engine that there is not
a ``UsageError``.
"""

try:
    import unified_planning  # noqa: F401  # the library is an extra: say so where it is missing
except ImportError as error:
    raise ImportError(
        "serendipity.up needs unified-planning: install the extra, serendipity-planner[up]", name=error.name
    ) from None

from serendipity._siblings import require_siblings

require_siblings("search", "verify")

from serendipity_up.engine import SerendipityEngine  # noqa: E402  # checked before anything loads them
from serendipity_up.kinds import ENGINE, register  # noqa: E402
from serendipity_up.plans import EpochPlan, to_plan  # noqa: E402
from serendipity_up.predicting import predict  # noqa: E402
from serendipity_up.reading import from_problem  # noqa: E402
from serendipity_up.writing import to_problem  # noqa: E402

__all__ = [
    "ENGINE",
    "EpochPlan",
    "SerendipityEngine",
    "from_problem",
    "predict",
    "register",
    "to_plan",
    "to_problem",
]

register()
