"""Calls asked of the planner, and of brute force or of the verifier."""

from typing import Any

import serendipity
from serendipity import Options, Result, Task, UsageError
from serendipity.testing.call import Call
from serendipity.testing.oracle import best
from serendipity.testing.oracle.answers import Optimum
from verify.calls.solve import solve


def exact_and_planned(call: Call) -> tuple[Optimum, Result] | None:
    """The optimum and the planner's answer; None where the call has no horizon, or too many ties."""
    try:
        optimum = best(call.task, call.options, call.human_plan)
    except UsageError:
        return None
    return optimum, serendipity.plan(call.task, human_plan=call.human_plan_names, **call.keywords())


def same_cost(call: Call) -> None:
    """Assert that status and cost are those of brute force, where that answers the call."""
    both = exact_and_planned(call)
    if both is not None:
        optimum, answer = both
        expected = None if optimum.cost is None else float(optimum.cost)
        assert (answer.status, answer.cost) == (optimum.status, expected)


def proved(task: Task, **options: Any) -> Result:
    """The planner's answer, once the certificate has proved it."""
    answer = serendipity.plan(task, **options)
    assert serendipity.verify(task, answer).verdict == "proved"
    return answer


def agreed(task: Task, human_plan: list[str] | None = None, **options: Any) -> Result:
    """The planner's answer, once both encodings and the certificate have agreed to it."""
    answer = proved(task, human_plan=human_plan, **options)
    figures = ("status", "cost", "objective", "opportunity", "saving", "saving_alone")
    for encoding in ("automata", "paper"):
        other = solve(task, Options(**options), human_plan=human_plan, encoding=encoding)
        assert [getattr(answer, name) for name in figures] == [getattr(other, name) for name in figures]
    return answer
