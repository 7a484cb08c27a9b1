"""Calls asked of the planner, and of brute force or of the verifier."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any, TypeVar

import serendipity
from serendipity import Options, PlanError, Result, Task, UsageError, Window
from serendipity.model.numbers import as_written
from serendipity_testing.call import Call
from serendipity_testing.oracle import best
from verify.calls.solve import solve

T = TypeVar("T")


def _or_refused(asked: Callable[[], T]) -> T | str:
    """What comes of a call, or what is wrong with it."""
    try:
        return asked()
    except PlanError:
        return "human plan"
    except UsageError as error:
        return str(error).partition(":")[0]


def _exact(value: float | None) -> Fraction | None:
    return None if value is None else as_written(value)


def assert_answered(call: Call) -> None:
    """Assert that every figure of an answer is that of brute force, or that both refuse the call."""
    result = _or_refused(
        lambda: serendipity.plan(call.task, human_plan=call.human_entries, **call.keywords())
    )
    optimum = _or_refused(lambda: best(call.task, call.options, call.human_plan))
    if isinstance(result, str) or isinstance(optimum, str):
        assert result == optimum
        return
    assert result.status == optimum.status
    assert _exact(result.cost) == optimum.cost
    assert result.opportunity == optimum.opportunity or call.options.ties == "expected"
    if call.options.ties == "expected" or optimum.cost is None:
        return
    assert _exact(result.objective) == optimum.objective
    assert _exact(result.saving) == optimum.saving
    if optimum.saving_alone is not None:
        assert _exact(result.saving_alone) == optimum.saving_alone
    assert result.lower_bound == result.objective
    if _settles_ties(call.task, result):
        assert result.window == optimum.window
        assert len(result.plan) == optimum.actions
    else:
        assert (_length(result.window), len(result.plan)) >= (_length(optimum.window), optimum.actions)


def _settles_ties(task: Task, result: Result) -> bool:
    """Whether plans of one objective are all told apart: else 100 nodes more are looked at (semantics)."""
    asked = {fact for goal in (task.goal, task.robot_goal) for fact in (*goal.positive, *goal.negative)}
    others = (action for action in task.actions if action.participants != (task.human,))
    changed = {fact for action in others for part in action.moments for fact in (*part.add, *part.delete)}
    return result.statistics["expanded"] <= 100 or asked.isdisjoint(changed)


def _length(window: Window | None) -> int:
    return 0 if window is None else len(window)


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
