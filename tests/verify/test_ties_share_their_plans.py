"""Ties: one search beside all optimal plans says what one question after another would."""

from collections import Counter
from dataclasses import replace
from itertools import pairwise
from random import Random
from typing import Any

import pytest

import serendipity
from serendipity.model import Options, Task
from serendipity.model.answers.result_parts import TiedAnswer
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_4
from serendipity_testing.generator.calls import random_call
from tests.verify.claims import claim_of
from verify.base.optimal_plans import OptimalPlans
from verify.base.plan_graph import OptimalPlanGraph
from verify.calls.answer import answer
from verify.calls.call import ExaminedCall
from verify.certificate.certify import certify
from verify.certificate.each_plan import kin
from verify.exhaustive.beside_plans import HelpBesidePlans, answers_all
from verify.exhaustive.epoch_by_epoch import OtherMethodError

ANY = 10**9


def errands(count: int) -> Task:
    """Things to do in any order, so that there are ``count!`` optimal plans; a robot shortens one of them."""
    actions = {f"do{k} h": f"-> d{k} @ 2" for k in range(count)}
    actions |= {"lay r": "-> t @ 1", "fast h": "t -> d0 @ 1"}
    return build(goal=" ".join(f"d{k}" for k in range(count)), actions=actions)


def _tied_calls(seed: int) -> list[ExaminedCall]:
    """A random call beside each optimal plan; empty where there are few, or robots have goals."""
    task, dice = random_call(seed).task, Random(f"ties {seed}")
    plans = OptimalPlans(task)
    graph = OptimalPlanGraph(task, plans, ANY)
    if graph.count < 2 or task.robot_goal:
        return []
    options = Options(
        mode="serendipity",
        discount=dice.choice(("0", "0.5", "0.9", "1/3", "1")),
        window_weight=dice.choice(("1000", "0.25", "0.75", "2", "0")),
        interference=dice.choice(("paper", "strict")),
        horizon=len(graph) + dice.choice((0, 0, 1, 2)),
    )
    return [ExaminedCall(task, options, plan, plans) for plan in graph.plans()]


def _score(call: ExaminedCall) -> tuple[int, int] | None:
    found = answer(call)
    if not found.opportunity or found.objective is None or found.cost is None:
        return None
    return call.prices.units(found.objective), call.prices.units(found.cost)


@pytest.mark.parametrize("bounded", [True, False])
@pytest.mark.parametrize("seeds", [range(60), pytest.param(range(60, 1500), marks=pytest.mark.slow)])
def test_one_search_finds_what_each_plan_allows(seeds: range, bounded: bool) -> None:
    helped = 0
    for seed in seeds:
        calls = _tied_calls(seed)
        if not calls:
            continue
        graph = OptimalPlanGraph(calls[0].task, calls[0].plans, ANY)
        try:
            found = HelpBesidePlans(calls[0].question, graph, calls[0].plans, bounded=bounded)
        except OtherMethodError:  # numbers that are too large for it
            continue
        scores = [_score(call) for call in calls]
        beside = [found.beside(call.human_plan or ()) for call in calls]
        assert (beside, found.scores) == (scores, Counter(scores)), seed
        helped += any(score is not None for score in scores)
    assert helped > 5


def test_plans_that_differ_are_told_apart() -> None:
    """Case 4: that via s can't be helped, that via r can (semantics 9)."""
    task = case_4()
    plans = OptimalPlans(task)
    graph = OptimalPlanGraph(task, plans, ANY)
    call = ExaminedCall(task, Options(discount="0.9"), plans.canonical(), plans)
    found = HelpBesidePlans(call.question, graph, plans, bounded=True)
    assert set(found.scores.values()) == {1}
    assert {None if s is None else float(call.prices.cost(s[1])) for s in found.scores} == {None, 6.2}


def test_the_graph_has_the_plans_and_no_others() -> None:
    for seed in range(40):
        task = random_call(seed).task
        plans = OptimalPlans(task)
        graph = OptimalPlanGraph(task, plans, ANY)
        listed = list(plans.plans())
        assert (list(graph.plans()), graph.count) == (listed, len(listed))
        for plan in listed:
            assert graph.named(tuple(task.actions[i].name for i in plan)) == plan


@pytest.mark.long
def test_too_many_plans_are_refused_without_listing_them() -> None:
    task = errands(12)
    with pytest.raises(serendipity.UsageError, match="more than 1000 optimal plans"):
        OptimalPlanGraph(task, OptimalPlans(task), 1000)


@pytest.mark.parametrize("ties", ["expected", "robust", "optimistic"])
@pytest.mark.parametrize(("method", "most"), [("auto", 250), ("exhaustive", 2000)])
def test_many_plans_are_one_search(ties: str, method: str, most: int) -> None:
    task = errands(5)
    result = serendipity.plan(task, ties=ties, discount="0.5")
    certificate = certify(task, result, method=method)
    best = claim_of(certificate, "optimal")
    assert (certificate.verdict, best.method) == ("proved", "exhaustive")
    assert best.solver_calls <= 1  # whether anything helps at all
    assert best.size["states"] < most  # 120 plans, 32 states of the human's


TOLD: dict[str, Any] = {"mode": "communication", "ties": "expected", "discount": "0.5"}


@pytest.mark.parametrize(
    ("asked", "calls"), [({}, 1), ({"communication_weight": 1}, 1), ({"keep_prefix": True}, 1)]
)
def test_a_told_human_is_asked_once_for_plans_of_the_same_actions(asked: dict[str, Any], calls: int) -> None:
    task = errands(3)
    result = serendipity.plan(task, **TOLD, **asked)
    certificate = certify(task, result, method="program")
    assert certificate.verdict == "proved"
    assert certificate.solver_calls <= 2 * calls  # six plans; a tie takes a second look


def test_plans_of_one_kin_have_one_answer() -> None:
    dice, shared = Random("kin"), 0
    for seed in range(60):
        task = random_call(seed).task
        plans = OptimalPlans(task)
        if task.robot_goal:
            continue
        asked: dict[str, Any] = {"mode": "communication", "discount": "0.5"}
        asked |= dice.choice(({}, {"communication_weight": "1"}, {"keep_prefix": True, "window_weight": "2"}))
        graph = OptimalPlanGraph(task, plans, ANY)
        known: dict[object, object] = {}
        for plan in graph.plans():
            call = ExaminedCall(task, Options(**asked), plan, plans)
            found = answer(call)
            figures = found.cost, found.objective, found.opportunity
            shared += kin(call) in known
            assert known.setdefault(kin(call), figures) == figures, seed
    assert shared > 10


def test_robust_rests_on_the_plan_that_is_left_alone() -> None:
    """No answer is dearer than leaving the human alone, so others need not be asked for."""
    task = case_4()
    result = serendipity.plan(task, ties="robust", discount="0.9")
    certificate = certify(task, result, method="program")
    assert result.ties is not None
    assert (certificate.verdict, certificate.solver_calls) == ("proved", len(result.ties))
    assert "none is dearer" in claim_of(certificate, "no_opportunity").reason


@pytest.mark.long
@pytest.mark.parametrize("method", ["auto", "program", "exhaustive"])
@pytest.mark.parametrize("ties", ["expected", "robust", "optimistic"])
def test_wrong_ties_are_refuted_by_every_method(ties: str, method: str) -> None:
    """An answer that denies help beside the plans that it lists, and one that makes it up."""
    for task, discount in ((errands(3), "0.5"), (errands(3), "0"), (case_4(), "0.9")):
        result = serendipity.plan(task, ties=ties, discount=discount)
        assert certify(task, result, method=method).verdict == "proved"
        assert result.ties is not None
        for k, listed in enumerate(result.ties):
            other = replace(listed, cost=(listed.cost or 0) - 0.5, opportunity=True)
            wrong = replace(result, ties=(*result.ties[:k], other, *result.ties[k + 1 :]))
            assert certify(task, wrong, method=method).verdict == "refuted", (discount, k)
        stranger = TiedAnswer((*result.ties[0].human_plan, "fast h"), 1.0, opportunity=True)
        wrong = replace(result, ties=(*result.ties, stranger))
        assert certify(task, wrong, method=method).verdict == "refuted"


def test_a_rule_that_one_search_does_not_know_is_asked_plan_by_plan() -> None:
    task = case_4()
    plans = OptimalPlans(task)
    for asked in ({"suffix": "subplan"}, {"preservation": "state"}, {"max_window": 1}, {"max_cost": 7}):
        options = Options(discount="0.9", **asked)
        assert not answers_all(ExaminedCall(task, options, plans.canonical(), plans).question)
        result = serendipity.plan(task, ties="expected", discount="0.9", **asked)
        assert certify(task, result).verdict == "proved", asked


@pytest.mark.parametrize("ties", ["expected", "optimistic"])
def test_help_may_wait_on_any_of_many_plans(ties: str) -> None:
    """A window of one epoch opens on each plan's own way, not on the canonical one's alone."""
    ways = {}
    for way in "abcd":
        places = ("start", f"{way}1", f"{way}2", f"{way}3", "goal")
        ways |= {f"go-{p} h {q}": f"{p} -> {q} !{p}" for p, q in pairwise(places)}
    task = build(init="start", goal="goal", actions={**ways, "meet h r": "d1 -> goal"})
    result = serendipity.plan(task, ties=ties, discount="0.9")
    assert (result.cost, result.opportunity) == ({"expected": 3.5, "optimistic": 2.0}[ties], True)
    assert certify(task, result).verdict == "proved"
