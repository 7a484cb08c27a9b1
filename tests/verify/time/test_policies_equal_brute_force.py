"""Policies in time: the verifier's search finds what brute force finds, and proves what the planner finds."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity.model import Condition, Options, Result, Task, UsageError
from serendipity.model.task.unit_steps import unit_steps
from serendipity_testing.oracle.scenarios import best_policy
from serendipity_testing.strategies.time import tasks_in_time
from tests.search.modes.scenarios.test_in_time import calls_in_time, library
from tests.verify.scenarios.test_policies_equal_brute_force import require_least
from verify.base.beside_script import alone_of
from verify.base.optimal_plans import OptimalPlans
from verify.calls.call import ExaminedCall


@pytest.mark.long
@given(calls_in_time())
@settings(max_examples=25)
def test_the_least_value_is_that_of_brute_force(drawn: tuple[Task, list[Candidate], Options] | None) -> None:
    if drawn is None:
        return
    task, scenarios, options = drawn
    horizon = int(options.horizon or max(task.epochs_of(one.plan) for one in scenarios))
    right = best_policy(task, options, scenarios, horizon)
    calls = [_call(task, options.but(horizon=horizon), scenario) for scenario in scenarios]
    require_least(calls, [scenario.weight for scenario in scenarios], right)


def _call(task: Task, options: Options, scenario: Candidate) -> ExaminedCall:
    units = unit_steps(task.with_goal(scenario.goal))
    plans = OptimalPlans(units.task, alone_of(units.task, options=options))
    return ExaminedCall(units.task, options, units.plan(scenario.plan), plans)


@given(calls_in_time())
@settings(max_examples=25)
def test_answers_about_a_library_are_proved(drawn: tuple[Task, list[Candidate], Options] | None) -> None:
    if drawn is not None:
        task, scenarios, options = drawn
        _prove(task, options, plans=library(task, scenarios))


@pytest.mark.long
@given(tasks_in_time(), st.sampled_from(["fixed", "watched"]), st.booleans(), st.data())
@settings(max_examples=25)
def test_answers_about_goals_and_ties_are_proved(
    drawn: Task, ties: str, several: bool, data: st.DataObject
) -> None:
    task = drawn.with_goal(drawn.goal, Condition())
    facts = [data.draw(st.sampled_from(task.facts)) for _ in range(2)]
    options = Options(ties=ties, policy=data.draw(st.sampled_from(["watching", "fixed"])))
    goals = [{"name": f"goal {k}", "goal": [fact], "prior": f"{2 * k + 1}/4"} for k, fact in enumerate(facts)]
    _prove(task, options, **({"goals": goals} if several or ties == "fixed" else {}))


def _prove(task: Task, options: Options, **unsure: object) -> None:
    asked = {name: getattr(options, name) for name in Options.__dataclass_fields__}
    try:
        answer = serendipity.plan(task, **unsure, **asked)
    except UsageError:  # what a plan reaches does not last
        return
    answer = Result.from_dict(json.loads(json.dumps(answer.to_dict())))
    certificate = serendipity.verify(task, answer)
    assert certificate.verdict == "proved", certificate
    assert all(claim.verdict != "refuted" for claim in serendipity.check(task, answer).claims)
