"""Strategies keep to what they are asked for; a case in Python builds the task that it shows."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from serendipity.model import Options, Task
from serendipity_testing import Call, best, calls, options, plans, random_call, results, strips_tasks, tasks
from serendipity_testing.asking import call_of, settled, written
from serendipity_testing.builders import task as build
from serendipity_testing.cases import CASE_3_PLAN, case_3
from serendipity_testing.in_python import in_python

FEW = settings(max_examples=settings.default.max_examples // 4)


@FEW
@given(strips_tasks(facts=(4, 4), robots=(1, 1), costs=("7",)))
def test_sizes_and_costs_are_those_asked_for(task: Task) -> None:
    assert len(task.facts) <= 4
    assert task.agents == ("hum", "rob")
    assert {action.cost for action in task.actions if task.human in action.participants} <= {7}


@FEW
@given(st.data(), tasks())
def test_options_and_plans_are_legal(data: st.DataObject, task: Task) -> None:
    chosen = data.draw(options(task, modes=("communication",)))
    assert chosen.mode == "communication"
    best(task, chosen)  # refused where an option isn't legal for the task
    plan = data.draw(plans(task))
    if plan is not None:
        task.replay_alone(plan)


@settings(max_examples=settings.default.max_examples // 10)
@given(results(of=calls(ties=False)))
def test_results_follow_the_rules(drawn: tuple[Task, serendipity.Result]) -> None:
    task, result = drawn
    assert serendipity.check(task, result).verdict != "refuted"


@pytest.mark.parametrize("seed", range(30))
def test_a_case_in_python_is_the_same_task(seed: int) -> None:
    call = random_call(seed)
    task = eval(in_python(call.task), {"task": build})
    asked = Options(discount="1/3")
    assert best(task, asked) == best(call.task, asked)


@FEW
@given(calls(ties=False))
def test_a_call_as_text_is_the_same_call(call: Call) -> None:
    assert call_of(written(call)) == call


def test_a_settled_call_has_its_plan_and_its_horizon() -> None:
    asked = settled(Call(case_3(), Options()))
    assert (asked.options.horizon, len(asked.human_plan or ())) == (7, 7)
    given_plan = case_3().plan_from_names(CASE_3_PLAN)
    assert settled(Call(case_3(), Options(horizon=9), given_plan)).human_plan == given_plan
