"""Certificates: true results are proved, doctored ones refuted, and a time limit is never a proof."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given

from serendipity.model import Certificate, Claim, Condition, InputError, Options, Result, Task, UsageError
from tests.cases import CASE_3_PLAN, case_1, case_2, case_3, case_4, case_8, case_9, case_10
from tests.strategies import Call, calls
from tests.verify.results import result
from tests.verify.test_rules import CASE_2_PI_H, CASE_4_PI_H, DOCTORED
from verify.certify import certify
from verify.solve import solve


def _claim(certificate: Certificate, name: str) -> Claim:
    return next(claim for claim in certificate.claims if claim.claim == name)


def _solved(task: Task, human_plan: tuple[str, ...] | None = None, **options: Any) -> Result:
    return solve(task, Options(**options), human_plan=human_plan)


# -- true results


@given(calls())
def test_answers_are_proved(call: Call) -> None:
    try:
        answer = solve(call.task, call.options, human_plan=call.human_plan_names)
    except UsageError:
        return
    assert answer.status != "unknown"
    certificate = certify(call.task, answer)
    assert certificate.verdict == "proved", certificate.to_dict()


@pytest.mark.parametrize("encoding", ["automata", "paper"])
@pytest.mark.parametrize("solver", ["highs", "cbc"])
def test_every_encoding_and_solver_proves(encoding: str, solver: str) -> None:
    task = case_10()
    answer = _solved(task, discount="0.5", horizon=2)
    certificate = certify(task, answer, encoding=encoding, solver=solver)
    assert certificate.verdict == "proved"
    assert certificate.encoding == encoding
    assert {claim.claim for claim in certificate.claims} == {
        "replay", "cost", "window", "optimal", "lower_bound",
    }  # fmt: skip


def test_no_opportunity_is_proved() -> None:
    task = case_1()
    certificate = certify(task, _solved(task, discount="0.5"))
    assert _claim(certificate, "no_opportunity").verdict == "proved"


@pytest.mark.parametrize(
    ("task", "options"),
    [
        (case_8(), {"mode": "serendipity"}),
        (case_8(), {"mode": "individual"}),
        (case_8(), {"mode": "composite", "horizon": 1}),
        (case_8(), {"mode": "communication", "horizon": 1}),
    ],
)
def test_infeasible_is_proved(task: Task, options: dict[str, Any]) -> None:
    answer = _solved(task, **options)
    assert answer.status == "infeasible"
    assert _claim(certify(task, answer), "infeasible").verdict == "proved"


def test_pi_h_is_said_to_be_canonical_or_given() -> None:
    task = case_4()
    assert "canonical optimal plan" in _claim(certify(task, _solved(task)), "replay").reason
    other = _solved(task, CASE_4_PI_H, discount="0.9")
    canonical = _solved(task, discount="0.9")
    assert other.human_plan == canonical.human_plan
    lazy = _solved(case_3(), CASE_3_PLAN)
    assert "pi_H is" in _claim(certify(case_3(), lazy), "replay").reason


def test_another_given_plan_is_refuted() -> None:
    task = case_3()
    answer = _solved(task, CASE_3_PLAN, discount="0.9")
    assert certify(task, answer, human_plan=CASE_3_PLAN).verdict == "proved"
    other = _claim(certify(task, answer, human_plan=CASE_3_PLAN[1:]), "replay")
    assert other.verdict == "refuted"


# -- doctored results


@pytest.mark.parametrize("name", DOCTORED)
def test_what_rules_refute_is_refuted(name: str) -> None:
    built = DOCTORED[name][1]()
    if name in ("another human", "pi_H with an unknown step"):
        with pytest.raises(InputError, match="another task"):
            certify(built.task, built.result)
    else:
        assert certify(built.task, built.result).verdict == "refuted"


def _dearer() -> tuple[Task, Result]:
    """The plan that K = 0 is answered, claimed optimal for K = 1000."""
    task = case_2()
    plan = {
        1: "move h a b; move rob s u",
        2: "move h b c; pick_up_medkit rob k u",
        3: "move rob u s",
        4: "move rob s c",
        5: "hand_over rob h k c",
        6: "move h c g",
        7: "conduct_triage h g",
    }
    return task, result(task, plan, human_plan=CASE_2_PI_H, window=(3, 6), discount="0.5")


def _wasteful(**options: Any) -> tuple[Task, Result]:
    """A needless action of the robot before the best plan."""
    task = case_4()
    plan = {
        1: "move h a b; pick_up_medkit rob k2 r",
        2: "move h b c; move rob r c",
        3: "hand_over rob h k2 c",
        4: "move h c d",
        5: "move h d g",
        6: "conduct_triage h g",
    }
    if options["mode"] == "communication":
        plan[4] += "; move rob c d"
        return task, result(task, plan, human_plan=CASE_4_PI_H, discount="0.9", **options)
    plan = {**plan, 3: "hand_over rob h k2 c", 4: "move h c d; move rob c d"}
    return task, result(task, plan, human_plan=CASE_4_PI_H, discount="0.9", window=(3, 5), **options)


def _denied(mode: str) -> tuple[Task, Result]:
    task = case_4()
    plan = dict(enumerate(CASE_4_PI_H, start=1))
    return task, result(task, plan, human_plan=CASE_4_PI_H, discount="0.9", mode=mode)


def _hasty_bound() -> tuple[Task, Result]:
    """``pi_H`` as the best so far, with a bound above what help would cost (6.2)."""
    task, denied = _denied("serendipity")
    return task, replace(denied, status="feasible", lower_bound=6.5)


def _tied(ties: str, **fields: Any) -> tuple[Task, Result]:
    task = case_4()
    return task, replace(_solved(task, discount="0.9", ties=ties), **fields)


def _other_ties() -> tuple[Task, Result]:
    task, robust = _tied("robust")
    return task, replace(robust, options=robust.options.but(ties="optimistic"))


def _infeasible(task: Task, horizon: int) -> tuple[Task, Result]:
    answer = _solved(task, mode="composite", horizon=1)
    return task, replace(answer, options=answer.options.but(horizon=horizon), horizon=horizon)


def _wrong_saving_alone() -> tuple[Task, Result]:
    """A given plan with a detour, whose own improvement is denied."""
    task = case_9()
    detour = replace(
        task,
        actions=(replace(task.actions[0], name="do h slowly", cost=task.actions[0].cost + 1), *task.actions),
    )
    detour = replace(detour, actions=tuple(sorted(detour.actions, key=lambda action: action.key)))
    answer = _solved(detour, ("do h slowly",))
    return detour, replace(answer, saving_alone=0.5)


def _forgotten_robots_goal() -> tuple[Task, Result]:
    """``saving`` compares with what doing nothing costs while robots reach ``G_R``."""
    task = case_10()
    wanted = replace(task, robot_goal=Condition((task.facts.index("q"),), ()))
    answer = _solved(wanted, discount="0.5", horizon=2)
    return wanted, replace(answer, saving=2.5)


REFUTED: dict[str, tuple[str, Callable[[], tuple[Task, Result]]]] = {
    "a longer window claimed optimal": ("optimal", _dearer),
    "a needless action, without communication": ("optimal", lambda: _wasteful(mode="serendipity")),
    "a needless action, with communication": ("optimal", lambda: _wasteful(mode="communication")),
    "an opportunity missed, without communication": ("no_opportunity", lambda: _denied("serendipity")),
    "an opportunity missed, with communication": ("optimal", lambda: _denied("communication")),
    "an opportunity missed, composite": ("optimal", lambda: _denied("composite")),
    "a bound above the optimum": (
        "lower_bound",
        lambda: (_dearer()[0], replace(_dearer()[1], status="feasible", lower_bound=1008.6)),
    ),
    "a bound above an opportunity not yet found": ("lower_bound", _hasty_bound),
    "the robust answer called optimistic": ("optimal", _other_ties),
    "infeasible though there is a plan": ("infeasible", lambda: _infeasible(case_8(), 2)),
    "saving_alone wrong": ("cost", _wrong_saving_alone),
    "saving wrong with a robots' goal": ("cost", _forgotten_robots_goal),
    "a dearer individual plan": (
        "optimal",
        lambda: (
            case_3(),
            result(
                case_3(),
                dict(enumerate(("move h a b", "move h b a", *CASE_3_PLAN), start=1)),
                human_plan=("move h a b", "move h b a", *CASE_3_PLAN),
                mode="individual",
            ),
        ),
    ),
}


@pytest.mark.parametrize("name", REFUTED)
def test_doctored_results_are_refuted_by_the_right_claim(name: str) -> None:
    claim, make = REFUTED[name]
    task, doctored = make()
    refuted = certify(task, doctored).refuted
    assert refuted is not None
    assert refuted.claim == claim, refuted


@given(calls(modes=("serendipity", "communication", "composite"), ties=False))
def test_every_opportunity_that_is_denied_is_refuted(call: Call) -> None:
    try:
        helped = solve(call.task, call.options, human_plan=call.human_plan_names)
    except UsageError:
        return
    if not helped.opportunity or call.task.robot_goal:
        return
    assert helped.human_plan is not None
    plan = dict(enumerate(helped.human_plan, start=1))
    options = {name: getattr(call.options, name) for name in call.options.to_dict()}
    denied = result(call.task, plan, human_plan=helped.human_plan, **options)
    denied = replace(denied, horizon=helped.horizon, saving_alone=helped.saving_alone)
    certificate = certify(call.task, denied)
    assert certificate.verdict == "refuted"


@pytest.mark.parametrize("encoding", ["automata", "paper"])
def test_a_better_plan_is_shown(encoding: str) -> None:
    task, doctored = _dearer()
    optimal = _claim(certify(task, doctored, encoding=encoding), "optimal")
    assert optimal.counterexample is not None
    assert "cost 8.5, objective 1008.5, window [4, 5)" in optimal.reason


# -- bounds of unfinished answers


@pytest.mark.parametrize(("bound", "verdict"), [(1008.5, "proved"), (3.25, "proved"), (1008.75, "refuted")])
def test_bounds_of_feasible_answers(bound: float, verdict: str) -> None:
    task, doctored = _dearer()
    certificate = certify(task, replace(doctored, status="feasible", lower_bound=bound))
    assert _claim(certificate, "lower_bound").verdict == verdict
    assert all(claim.claim != "optimal" for claim in certificate.claims)


# -- limits


@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite"])
@pytest.mark.parametrize("encoding", ["automata", "paper"])
def test_a_time_limit_is_never_a_proof(mode: str, encoding: str) -> None:
    task = case_4()
    answer = _solved(task, mode=mode, discount="0.9")
    certificate = certify(task, answer, encoding=encoding, time_limit=0)
    assert certificate.verdict == "undecided"
    assert _claim(certificate, "optimal").verdict == "undecided"
    assert "time limit" in _claim(certificate, "optimal").reason


def test_solve_in_no_time_is_unknown() -> None:
    answer = _solved(case_4(), time_limit=0)
    assert (answer.status, answer.plan, answer.cost) == ("unknown", None, None)
    assert certify(case_4(), answer).verdict == "proved"


# -- bad input


def test_a_result_for_another_task() -> None:
    answer = _solved(case_4())
    with pytest.raises(InputError, match="another task"):
        certify(case_1(), answer)


def test_unknown_encoding_and_solver() -> None:
    answer = _solved(case_4())
    with pytest.raises(UsageError, match="encoding: expected one of automata, paper"):
        certify(case_4(), answer, encoding="enigma")
    with pytest.raises(UsageError, match="solver: expected one of highs, cbc"):
        certify(case_4(), answer, solver="abacus")


@pytest.mark.parametrize(
    "options", [Options(mode="assistance"), Options(human_model="observant")], ids=["assistance", "observant"]
)
def test_what_no_program_answers(options: Options) -> None:
    with pytest.raises(UsageError, match="solve: expected"):
        solve(case_4(), options)


def test_claims_out_of_scope_say_why() -> None:
    answer = _solved(case_4(), discount="0.9")
    answer = replace(answer, options=answer.options.but(human_model="observant"), realised={})
    certificate = certify(case_4(), answer)
    for name in ("optimal", "lower_bound"):
        claim = _claim(certificate, name)
        assert (claim.verdict, bool(claim.reason)) == ("not_in_scope", True)
