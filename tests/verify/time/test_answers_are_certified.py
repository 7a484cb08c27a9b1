"""Answers in time are proved by each method, with proof files, and doing nothing is refuted where help is."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Result, Task, UsageError
from serendipity.model.keywords import Ties
from serendipity_testing.builders import task as build
from serendipity_testing.call import Call
from serendipity_testing.crosscheck.doctored import without_plan
from serendipity_testing.oracle import best
from serendipity_testing.strategies.time import calls_in_time
from tests.facade import test_results_tell_times as times
from tests.verify.denied import denied
from verify.certificate.certify import certify
from verify.limits import limited


def answered(call: Call) -> Result:
    """The answer to a call of what the verifier knows in time."""
    return times.answered(call)


@pytest.mark.long
@given(calls_in_time(), st.sampled_from(["auto", "program", "exhaustive"]))
def test_answers_are_proved(call: Call, method: str) -> None:
    result = answered(call)
    certificate = certify(call.task, result, method=method)
    assert certificate.verdict == "proved", certificate
    assert all(claim.verdict != "refuted" for claim in serendipity.check(call.task, result).claims)


@pytest.mark.long
@given(
    calls_in_time(modes=("serendipity", "communication")),
    st.sampled_from(["robust", "optimistic", "expected"]),
)
def test_answers_over_ties_are_proved(call: Call, ties: Ties) -> None:
    result = answered(replace(call, options=call.options.but(ties=ties), human_plan=None))
    assert serendipity.verify(call.task, result).verdict == "proved"


def test_of_plans_of_one_length_those_of_the_fewest_actions_are_optimal() -> None:
    """The other plan, of two actions, could be helped between them."""
    actions = {
        "begin h": "-> q @ 1",
        "end h": "q -> p @ 1",
        "whole h": "-> p @ 2 [2]",
        "lift r": "-> up @ 0",
        "turn r": "up -> on @ 0",
        "short h": "on -> p @ 0",
    }
    task = build(goal="p", actions=actions)
    answer = serendipity.plan(task, ties="optimistic", horizon=3)
    assert [tied.human_plan for tied in answer.ties or ()] == [("whole h",)]
    certificate = serendipity.verify(task, answer)
    assert certificate.verdict == "proved", certificate
    assert "the human's canonical optimal plan" in certificate.claims[0].reason


@pytest.mark.long
@given(calls_in_time())
def test_proofs_are_accepted(tmp_path_factory: object, call: Call) -> None:
    result = answered(call)
    file = Path(tmp_path_factory.mktemp("proof")) / "proof.json"  # type: ignore[attr-defined]
    try:
        serendipity.verify(call.task, result, proof=file)
    except UsageError:
        assume(False)
    assert not file.exists() or serendipity.check_proof(file, call.task, result).verdict == "accepted"


@pytest.mark.long
@given(calls_in_time(modes=("serendipity",)), st.sampled_from(["program", "exhaustive"]))
def test_doing_nothing_is_refuted_where_brute_force_helps(call: Call, method: str) -> None:
    result = answered(call)
    optimum = best(call.task, call.options, call.human_plan)
    if not optimum.opportunity or call.task.robot_goal or result.saving_alone:
        return
    certificate = certify(call.task, denied(call.task, result), method=method)
    assert certificate.verdict == "refuted", (optimum, certificate)
    refuted = next(claim for claim in certificate.claims if claim.verdict == "refuted")
    assert refuted.counterexample is not None, refuted


def closing() -> Task:
    """Whoever is done in the first epoch has to do it again: it costs the human an epoch of waiting."""
    built = build(goal="done", actions={"do h": " -> done @ 1", "aid r": " -> done @ 1"})
    return built.with_script(serendipity.Script(facts=[(1, "!done")]))


def test_who_waits_for_nothing_is_told_apart_in_whatever_automaton() -> None:
    right = serendipity.plan(closing(), waiting_cost=1)
    assert (right.cost, right.human_cost) == (1, 2)
    wrong = without_plan(right, "unknown", "time-limit", 2.0)
    with limited(automaton_states=1, states_a_value=0):
        assert serendipity.verify(closing(), wrong).verdict == "refuted"


def test_what_a_head_start_costs_is_no_saving_alone() -> None:
    right = serendipity.plan(closing(), waiting_cost=1, head_start=3)
    for wrong in (
        replace(right, saving_alone=1.0),
        replace(right, options=right.options.but(head_start=4)),
    ):
        assert serendipity.verify(closing(), wrong).verdict == "refuted"
    assert serendipity.verify(closing(), right).verdict == "proved"


def test_ties_behind_a_head_start_are_proved_for_who_is_at_something() -> None:
    session = serendipity.Session(
        build(goal="done", actions={"do h": " -> begun @ 1 [3]", "end h": "begun -> done"})
    )
    session.execute(["do h"])
    found = serendipity.plan(session.task, ties="robust", head_start=3)
    assert serendipity.verify(session.task, found).verdict == "proved"


def test_ties_under_the_rule_are_proved_where_the_best_plan_keeps_it_without_robots() -> None:
    """Before the head start is over a window lets the human begin while the door is open."""
    ways = {
        "early h": "!shut -> done @ 1 [2]",
        "late h": "shut warm -> done @ 2 [2]",
        "heat h": " -> warm !done @ 8",
        "close c": " -> shut !warm @ 1",
        "turn r": " -> on",
    }
    beside = serendipity.Script(people={"c": [(1, "close c")]})
    task = build(agents="h r c", goal="done", robot_goal="!on", actions=ways).with_script(beside)
    found = serendipity.plan(task, ties="optimistic", head_start=2, window_weight=0)
    assert (found.cost, found.opportunity) == (1, True)
    assert serendipity.verify(task, found).verdict == "proved"
