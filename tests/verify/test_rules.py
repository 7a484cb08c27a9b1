"""The rule checker accepts the worked cases and refutes doctored ones with the right rule."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Options, Task
from serendipity.model.answers.result_parts import TiedAnswer
from serendipity_testing.builders import task as build
from serendipity_testing.countdown import Countdown
from serendipity_testing.generator import random_call
from serendipity_testing.oracle import Alone as OracleAlone
from serendipity_testing.oracle import Moment
from serendipity_testing.oracle.epochs import after
from serendipity_testing.strategies import family_tasks, tasks
from tests.verify.claims import verdicts
from tests.verify.doctored import RULE_BROKEN
from tests.verify.valid import VALID, Given, helped, idle
from verify.base.individual import IndividualOptimum
from verify.certificate.certify import certify
from verify.limits import limited
from verify.rules import CLAIMS, RULES, check


@pytest.mark.parametrize("make", VALID)
def test_valid_results_pass(make: Callable[[], Given]) -> None:
    built = make()
    report = check(built.task, built.result)
    assert report.ok, str(report.first)
    assert not report.unchecked


@pytest.mark.parametrize("name", RULE_BROKEN)
def test_doctored_results_are_refuted_with_the_right_rule(name: str) -> None:
    rule, make = RULE_BROKEN[name]
    built = make()
    report = check(built.task, built.result)
    assert report.first is not None
    assert report.first.rule == rule, str(report.first)


def test_every_rule_refutes_something() -> None:
    refuted = {rule for rule, _ in RULE_BROKEN.values()}
    missing = {rule.name for rule in RULES} - refuted - {"ties-mean"}  # which has a test of its own
    assert not missing, (
        f"no doctored result breaks {missing}: add one to RULE_BROKEN in tests/verify/doctored.py"
    )


def test_expected_cost_has_to_be_the_mean() -> None:
    built = idle()
    plan = built.result.human_plan or ()
    answers = (
        TiedAnswer(plan, cost=6.2, opportunity=True),
        TiedAnswer(plan[::-1], cost=8.0, opportunity=False),
    )
    mean = replace(
        built.result,
        options=Options(discount="0.9", ties="expected"),  # type: ignore[arg-type]
        plan=None,
        opportunity=True,
        cost=7.1,
        saving=0.9,
        agent_costs={},
        ties=answers,
    )
    assert check(built.task, mean).ok
    for doctored, rule in (
        (replace(mean, cost=7.0), "ties-mean"),
        (replace(mean, opportunity=False), "ties-mean"),
        (replace(mean, ties=None), "ties"),
        (replace(mean, ties=(answers[0], replace(answers[1], human_plan=plan))), "ties"),
    ):
        report = check(built.task, doctored)
        assert report.first is not None
        assert report.first.rule == rule


def test_a_violation_names_epoch_and_action() -> None:
    built = RULE_BROKEN["an action dropped"][1]()
    first = check(built.task, built.result).first
    assert first is not None
    assert (first.epoch, first.action) == (3, "hand_over rob h k2 c")
    assert "'has rob k2' is false" in str(first)


def test_help_needs_a_plan_of_the_humans_even_where_nobody_says_it_is_the_best() -> None:
    """Robots that reach both goals are no answer in a mode of windows where the human has no plan alone."""
    actions = {"do h": "open -> done", "bring r": "-> done @ 2", "tidy r": "-> tidy"}
    task = build(goal="done", robot_goal="tidy", actions=actions)
    joint = serendipity.plan(task, mode="composite", horizon=3)
    assert (joint.status, joint.human_plan) == ("optimal", None)
    windows = replace(joint, mode="serendipity", options=joint.options.but(mode="serendipity"), horizon=None)
    for status in ("optimal", "feasible"):
        report = check(task, replace(windows, status=status))
        assert not report.ok
    assert certify(task, replace(windows, status="feasible")).verdict == "refuted"


def test_rules_stand_in_the_order_of_their_claims() -> None:
    claims = [rule.claim for rule in RULES]
    assert claims == sorted(claims, key=CLAIMS.index)
    assert len({rule.name for rule in RULES}) == len(RULES)


@pytest.mark.parametrize("many", [0, 1_000])
@given(task=tasks() | family_tasks(), data=st.data())
def test_his_optimal_cost_alone_equals_the_oracle(many: int, task: Task, data: st.DataObject) -> None:
    """From a random state that a few arbitrary actions lead to, whenever it is asked what is in reach."""
    state = task.init
    for _ in range(data.draw(st.integers(0, 3))):
        ready = [action for action in task.actions if action.applicable(state)]
        if ready:
            state = after(state, [data.draw(st.sampled_from(ready))])
    worth = OracleAlone(task).worth(Moment(state))
    with limited(many_own_states=many):
        alone = IndividualOptimum(task)
        assert alone.optimum(state) == (None if worth is None else (worth[0], worth[2]))
        weight = alone.weight(state)
        for most in (10**15,) if weight is None else (weight - 1, weight):
            assert IndividualOptimum(task).within(state, most) == (most == weight)


def test_a_goal_out_of_reach_is_told_without_listing_states() -> None:
    """All that can be switched was, until there were too many states: ten seconds and 600 MiB."""
    switches = {f"switch{i} h": f"-> on{i}" for i in range(30)}
    after_all = {"light h": f"key {' '.join(f'on{i}' for i in range(30))} -> lit", "light r": "-> lit"}
    built = build(goal="lit", actions=switches | after_all)
    deadline = Countdown(20_000)
    assert IndividualOptimum(built, deadline).optimum(built.init) is None


def test_what_is_too_hard_for_a_rule_is_not_proved() -> None:
    """Whether the suffix is the human's optimal plan is a question of its own: no program answers it."""
    built = helped()
    with limited(own_states=0):
        report = check(built.task, built.result)
        found = verdicts(certify(built.task, built.result))
    assert (report.ok, report.stopped) == (True, None)
    assert report.undecided == {"window": "the human's own problem is too large"}
    assert found["window"] == "undecided"
    assert found["replay"] == "proved"


def test_an_end_of_pi_h_may_be_done_in_other_variants(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two actions of one name; after the window it is the other one that the human can do."""
    monkeypatch.setattr("serendipity_testing.generator.calls._ODD", 1.0)
    call = random_call(1011733)
    answer = serendipity.plan(call.task, **call.options)  # type: ignore[arg-type]
    assert answer.options.preservation == "state"
    assert serendipity.verify(call.task, answer).verdict == "proved"
