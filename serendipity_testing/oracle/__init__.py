"""A brute-force enumerator of composite plans: semantics 1-3 and 10, as literally as possible.

It walks forward over epochs through every state and every applicable action set,
for every window.  Nothing is pruned; equal (state, label) pairs are merged.  It is
slow, shares no code with ``search`` or ``verify``, and is what both are tested
against.

    optimum = best(task, Options(mode="serendipity", discount=0.6))
"""

from serendipity_testing.oracle.alone import Alone, human_plans, optimal_human_plan
from serendipity_testing.oracle.answers import Optimum
from serendipity_testing.oracle.best import best
from serendipity_testing.oracle.moments import Moment, action_sets

__all__ = [
    "Alone",
    "Moment",
    "Optimum",
    "action_sets",
    "best",
    "human_plans",
    "optimal_human_plan",
]
