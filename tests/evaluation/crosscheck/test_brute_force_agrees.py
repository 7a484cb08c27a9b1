"""Brute force answers what the search answers, on the calls that ``crosscheck`` makes."""

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.evaluation.crosscheck import random_call
from serendipity.facade.call import options_from
from serendipity.model import Options, UsageError
from serendipity.testing.oracle import best, optimal_human_plan
from serendipity.testing.oracle.reactions import best_reaction


def _float(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


@given(st.integers(0, 10**9))
def test_brute_force_agrees(seed: int) -> None:
    call = random_call(seed)
    options = options_from(call.keywords())
    if options.human_model != "omniscient":
        return
    given_plan = None if call.human_plan is None else call.task.plan_from_names(call.human_plan)
    try:
        optimum = best(call.task, options, given_plan)
    except UsageError:
        optimum = None
    try:
        answer = serendipity.plan(call.task, human_plan=call.human_plan, **call.keywords())
    except UsageError:
        assert optimum is None
        return
    assert optimum is not None
    assert answer.status == optimum.status
    for name in ("cost", "objective", "saving"):
        assert getattr(answer, name) == _float(getattr(optimum, name)), name
    assert answer.opportunity == optimum.opportunity


@given(st.integers(0, 10**9))
def test_brute_force_agrees_on_a_human_who_replans(seed: int) -> None:
    call = random_call(seed)
    task = call.task
    plan = optimal_human_plan(task)
    if not plan:
        return  # nothing to follow, or no horizon to take from it
    options = Options(discount=call.options["discount"], human_model="observant")  # type: ignore[arg-type]
    optimum = best_reaction(task, options, plan)
    answer = serendipity.plan(task, discount=call.options["discount"], human_model="observant")
    costs = [optimum.cost, None if task.robot_goal else task.cost_of(plan)]
    assert answer.cost == _float(min((cost for cost in costs if cost is not None), default=None))
