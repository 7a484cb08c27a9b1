"""Brute force with time keeps the laws of sections 3.1 and 10."""

from dataclasses import replace
from itertools import islice

import pytest
from hypothesis import given, settings

from serendipity.model import Condition, Options, PlanError, Task, TimedFact, Timeline, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.call import Call
from serendipity_testing.in_python import in_python
from serendipity_testing.oracle import Optimum, best, human_plans
from serendipity_testing.rewriting import renamed
from serendipity_testing.strategies import calls, calls_in_time, tasks_in_time
from serendipity_testing.strategies.time import small_tasks


def answered(call: Call) -> Optimum | str:
    """The answer, or what is wrong with the call."""
    try:
        return best(call.task, call.options, call.human_plan)
    except (PlanError, UsageError) as error:
        return str(error)


@settings(max_examples=40, deadline=None)
@given(calls(ties=False, of=small_tasks()))
def test_a_script_that_nobody_cares_for_changes_nothing(call: Call) -> None:
    task = call.task
    noise = Timeline(tuple(TimedFact(epoch, len(task.facts), epoch % 2 == 1) for epoch in (1, 3, 4)))
    noisy = replace(task, facts=(*task.facts, "noise"), script=noise)
    assert [*islice(human_plans(noisy), 20)] == [*islice(human_plans(task), 20)]
    assert answered(replace(call, task=noisy)) == answered(call)


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(calls_in_time())
def test_renaming_keeps_the_cost(call: Call) -> None:
    options = call.options.but(head_start=0)
    plan = call.human_plan or next(human_plans(call.task, options.waiting_cost, strict=options.strict), None)
    if plan is None:
        return
    settled = replace(call, options=options, human_plan=plan)
    before, after = answered(settled), answered(renamed(settled))
    if isinstance(before, Optimum) and isinstance(after, Optimum):
        assert (before.cost, before.objective, before.saving) == (after.cost, after.objective, after.saving)
    else:
        assert before == after


@settings(max_examples=40, deadline=None)
@given(tasks_in_time())
def test_tasks_are_told_in_python(built: Task) -> None:
    plain = replace(built, script=Timeline(), robot_goal=Condition())
    again = eval(in_python(plain), {"task": build})
    kinds = [(a.name.replace(" ", "_"), a.duration, a.cost) for a in plain.actions]
    assert [(a.name.replace(" ", "_"), a.duration, a.cost) for a in again.actions] == kinds
    assert best(again, Options(mode="individual")) == best(plain, Options(mode="individual"))
