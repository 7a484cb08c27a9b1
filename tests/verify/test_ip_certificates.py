"""Certificates: true results are proved, doctored ones refuted, and a time limit is never a proof."""

from dataclasses import replace

import pytest
from hypothesis import given

import serendipity
from serendipity.model import InputError, LimitReachedError, Options, UsageError
from serendipity_testing.by_hand import result
from serendipity_testing.cases import case_4, case_10
from serendipity_testing.strategies import Call, calls
from tests.verify.claims import claim_of
from tests.verify.denied import denied
from tests.verify.doctored import ANOTHER_TASK, DOCTORED
from tests.verify.untrue import dearer, solved
from verify.base.optimal_plans import OptimalPlans
from verify.calls.solve import solve
from verify.certificate.certify import certify
from verify.programs.effort import METHODS

# -- true results


@pytest.mark.parametrize("method", METHODS)
def test_answers_are_proved(method: str) -> None:
    @given(calls())
    def law(call: Call) -> None:
        try:
            answer = solve(call.task, call.options, human_plan=call.human_plan_names)
        except UsageError:
            return
        assert answer.status != "unknown"
        certificate = certify(call.task, answer, method=method)
        assert certificate.verdict == "proved", certificate.to_dict()

    law()


def test_what_pi_h_is_does_not_hold_up_a_certificate(monkeypatch: pytest.MonkeyPatch) -> None:
    def endless(plans: OptimalPlans) -> None:
        assert plans.deadline.left() is not None
        raise LimitReachedError("time-limit")

    answer = solved(case_4())
    monkeypatch.setattr(OptimalPlans, "canonical", endless)
    certificate = certify(case_4(), answer)
    assert certificate.verdict == "proved"
    assert "pi_H is" not in claim_of(certificate, "replay").reason


def test_no_answer_in_time_is_not_refuted() -> None:
    """Not even where the horizon was to be taken from a plan of the human's that was not found in time."""
    task = case_4()
    answer = serendipity.plan(task, mode="communication", time_limit=0)
    assert (answer.status, answer.human_plan, answer.horizon) == ("unknown", None, None)
    assert certify(task, answer).verdict != "refuted"


# -- doctored results


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", DOCTORED)
def test_doctored_results_are_refuted_by_the_rightclaim_of(name: str, method: str) -> None:
    doctored = DOCTORED[name]
    task, answer = doctored.make()
    if name in ANOTHER_TASK:
        with pytest.raises(InputError, match=r"another task|the options"):
            certify(task, answer, method=method)
        return
    refuted = certify(task, answer, method=method).refuted
    assert refuted is not None
    assert refuted.claim == doctored.claim, refuted


@given(calls(modes=("serendipity", "communication", "composite"), ties=False))
def test_every_opportunity_that_is_denied_is_refuted(call: Call) -> None:
    try:
        helped = solve(call.task, call.options, human_plan=call.human_plan_names)
    except UsageError:
        return
    if not helped.opportunity or call.task.robot_goal:
        return
    assert certify(call.task, denied(call.task, helped)).verdict == "refuted"


def test_a_better_plan_is_shown() -> None:
    task, doctored = dearer()
    optimal = claim_of(certify(task, doctored), "optimal")
    assert optimal.counterexample is not None
    assert "cost 8.5, objective 1008.5, window [4, 5)" in optimal.reason


@pytest.mark.parametrize("encoding", ["automata", "paper"])
def test_every_encoding_shows_a_better_plan(encoding: str) -> None:
    task = case_10()
    options = {"mode": "composite", "discount": "0.5", "horizon": 2}
    doctored = result(task, {1: "do1 h"}, human_plan=("do1 h",), **options)
    optimal = claim_of(certify(task, doctored, encoding=encoding), "optimal")
    assert optimal.counterexample is not None
    assert [step.action for step in optimal.counterexample] == ["lift r1 r2", "do2 h"]
    assert optimal.reason == "a better plan: cost 3, objective 3"


# -- bad input


@pytest.mark.parametrize(
    "options", [Options(mode="assistance"), Options(human_model="observant")], ids=["assistance", "observant"]
)
def test_what_no_program_answers(options: Options) -> None:
    with pytest.raises(UsageError, match="solve: expected"):
        solve(case_4(), options)


def test_claims_out_of_scope_say_why() -> None:
    answer = solved(case_4(), discount="0.9")
    observant = replace(answer, options=answer.options.but(human_model="observant"), realised={})
    for doctored, names in ((observant, ["window"]), (replace(answer, cost=1.0), ["optimal"])):
        certificate = certify(case_4(), doctored)
        for name in names:
            claim = claim_of(certificate, name)
            assert (claim.verdict, bool(claim.reason)) == ("not_in_scope", True)
