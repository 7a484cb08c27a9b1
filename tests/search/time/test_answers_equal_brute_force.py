"""Answers where actions take time, the human waits, or something happens anyway: those of brute force."""

from hypothesis import assume, given

import serendipity
from serendipity.model import PlanError, UsageError
from serendipity.testing.call import Call
from serendipity.testing.oracle import best
from serendipity.testing.strategies.time import calls_in_time

_PLAIN = {"suffix": "replan", "preservation": "kernel", "keep_prefix": False, "waiting_cost": 0}


def answered(call: Call) -> tuple[object, ...]:
    """Status and figures, or that the call is refused."""
    try:
        found = serendipity.plan(call.task, human_plan=call.human_entries, **call.keywords())
    except (UsageError, PlanError):
        return ("refused",)
    return found.status, found.cost, found.objective, found.window, found.opportunity


def expected(call: Call) -> tuple[object, ...]:
    try:
        found = best(call.task, call.options, call.human_plan)
    except (UsageError, PlanError):
        return ("refused",)
    figures = (None if figure is None else float(figure) for figure in (found.cost, found.objective))
    return (found.status, *figures, found.window, found.opportunity)


@given(calls_in_time())
def test_answers_are_those_of_brute_force(call: Call) -> None:
    assume(all(getattr(call.options, name) == value for name, value in _PLAIN.items()))
    assert answered(call) == expected(call)
