"""One call asked of brute force and of the planner."""

import serendipity
from serendipity import Result, UsageError
from serendipity.testing.call import Call
from serendipity.testing.oracle import best
from serendipity.testing.oracle.answers import Optimum


def exact_and_planned(call: Call) -> tuple[Optimum, Result] | None:
    """The optimum and the planner's answer; None where the call has no horizon, or too many ties."""
    try:
        optimum = best(call.task, call.options, call.human_plan)
    except UsageError:
        return None
    return optimum, serendipity.plan(call.task, human_plan=call.human_plan_names, **call.keywords())
