"""The best help with a human who replans is proved best, by playing all that could be better."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings

import serendipity
from serendipity.model import Certificate, Options, Result, Task, surroundings
from serendipity_testing.builders import task as build
from serendipity_testing.by_hand import result
from serendipity_testing.cases import case_1, case_4
from serendipity_testing.oracle.reactions import best_reaction
from tests.search.exact_answers import proved
from tests.search.modes.simulation.strategies import Reaction, reactions
from tests.verify.claims import claim_of, verdicts
from tests.verify.denied import denied
from verify.base.optimal_plans import OptimalPlans
from verify.calls.call import ExaminedCall
from verify.certificate.reactions import cheapest_reaction
from verify.limits import limited

MODELS = ["observant", "local"]


def _certified(task: Task, **options: object) -> tuple[Result, Certificate]:
    result = serendipity.plan(task, **options)
    return result, serendipity.verify(task, result)


@pytest.mark.long
@pytest.mark.parametrize("human_model", MODELS)
def test_every_answer_is_proved(human_model: str) -> None:
    @given(reactions(human_model))
    @settings(max_examples=60)
    def law(case: Reaction) -> None:
        names = [case.task.actions[i].name for i in case.human_plan] if case.given else None
        result, certificate = _certified(case.task, human_plan=names, **case.options.to_dict())
        assert certificate.verdict == "proved", (result, certificate)
        claims = verdicts(certificate)
        wanted = "optimal" if result.opportunity else "no_opportunity"
        assert claims["infeasible" if result.status == "infeasible" else wanted] == "proved"

    law()


@pytest.mark.long
@pytest.mark.parametrize("human_model", MODELS)
def test_what_is_played_is_what_brute_force_finds(human_model: str) -> None:
    @given(reactions(human_model))
    @settings(max_examples=60)
    def law(case: Reaction) -> None:
        task, options = case.task, case.options
        call = ExaminedCall(task, options, case.human_plan, OptimalPlans(task))
        found = cheapest_reaction(call, None).found
        cost = None if found is None else call.prices.cost(found.cost)
        assert cost == best_reaction(task, options, case.human_plan, surroundings(task).visible).cost

    law()


def test_worked_cases() -> None:
    result, certificate = _certified(case_1(), discount="0.9", human_model="observant")
    assert (result.cost, certificate.verdict) == (8.4, "proved")
    optimal = claim_of(certificate, "optimal")
    assert optimal.reason.startswith("no joint plan costs less than 8.4, whatever the human does")
    for ties in ("robust", "expected", "optimistic"):
        _, certificate = _certified(case_4(), discount="0.9", human_model="local", ties=ties)
        assert certificate.verdict == "proved", certificate


@pytest.mark.parametrize("human_model", MODELS)
def test_help_that_is_denied_is_found(human_model: str) -> None:
    task = case_1()
    result = serendipity.plan(task, discount="0.9", human_model=human_model)
    certificate = serendipity.verify(task, denied(task, result))
    refuted = certificate.refuted
    assert refuted.claim == "no_opportunity"
    assert refuted.reason.startswith("an opportunity: cost 8.4")
    assert sum(Fraction(str(step.cost)) for step in refuted.counterexample or ()) == Fraction("8.4")


def test_dearer_help_is_not_the_best() -> None:
    """An answer on the way, said to be the last one."""
    task = build(
        goal="p",
        actions={
            "go h": "-> there @ 1",
            "do1 h": "there !q !r -> p @ 9",
            "do2 h": "there q -> p @ 1",
            "do3 h": "there r -> p @ 2",
            "dear r": "!r -> q @ 6",
            "cheap r": "!q -> r @ 1",
        },
    )
    options = {"horizon": 2, "human_model": "observant"}
    *early, last = serendipity.plan_anytime(task, **options)
    assert (last.cost, serendipity.verify(task, last).verdict) == (4.0, "proved")
    without_cheap = replace(task, actions=tuple(a for a in task.actions if a.name != "cheap r"))
    dear = serendipity.plan(without_cheap, **options)
    assert dear.cost == 8.0
    refuted = serendipity.verify(task, dear).refuted
    assert (refuted.claim, refuted.reason) == ("optimal", "a better plan: cost 4, objective 4")
    for answer in early:
        assert serendipity.verify(task, answer).verdict == "proved"  # its bound is one
        bold = replace(answer, lower_bound=4.5)
        assert verdicts(serendipity.verify(task, bold))["lower_bound"] == "refuted"


def test_infeasible_is_examined() -> None:
    task = build(goal="p", robot_goal="q", actions={"do h": "-> p", "x r": "-> q"})
    proved(task, human_model="observant")
    denied = Result(
        "serendipity",
        "infeasible",
        "h",
        Options(human_model="observant"),
        human_plan=("do h",),
        human_cost=1.0,
        horizon=1,
        reason="no-plan-within-horizon",
    )
    assert verdicts(serendipity.verify(task, denied))["infeasible"] == "refuted"


def test_limits_leave_it_undecided() -> None:
    task = case_1()
    result = serendipity.plan(task, discount="0.9", human_model="observant")
    with limited(moments=3):
        only_played = serendipity.verify(task, result, method="exhaustive")
    assert verdicts(only_played)["optimal"] == "undecided"


@pytest.mark.parametrize(
    "numbers",
    [range(1, 201, 40), pytest.param(range(1, 201, 5), marks=pytest.mark.slow)],
    ids=["some", "more"],
)
@pytest.mark.parametrize("human_model", MODELS)
def test_usar_answers_are_proved(human_model: str, numbers: range, usar200: Path) -> None:
    for number in numbers:
        task = serendipity.load(usar200 / f"test{number}", human="commx")
        _, certificate = _certified(task, discount="0.9", human_model=human_model)
        assert certificate.verdict == "proved", (number, certificate)


def test_a_moment_that_a_later_epoch_reaches_at_less_cost_costs_what_it_did() -> None:
    """What was paid for a state is that of its epoch: with it the answer was refuted by a plan of 7.2."""
    actions = {
        "back0 h": "-> at0 !at1",
        "jump0 h": "at0 open0 -> at2 !at0",
        "walk0 h": "-> at1",
        "walk1 h": "at1 -> at2 !at1 @ 3",
        "walk2 h": "at2 -> at3 @ 3",
        "walk3 h": "at3 -> at4",
        "open0 r": "-> open0",
        "prepare r": "-> tired",
    }
    task = build(goal="at4", robot_goal="open0", actions=actions)
    result = proved(task, discount=0.9, ties="optimistic", human_model="local")
    assert result.cost == 8.1


@pytest.mark.parametrize("human_model", MODELS)
def test_without_help_the_answer_is_the_humans_own_plan(human_model: str) -> None:
    """``do h`` once more than needed, at twice the cost, said to be the best."""
    task = build(goal="g", actions={"do h": "-> g", "idle r": "-> q"})
    right = proved(task, human_model=human_model, horizon=2)
    twice = result(task, {1: "do h", 2: "do h"}, human_plan=("do h",), human_model=human_model, horizon=2)
    twice = replace(twice, saving=0.0, realised=right.realised)
    assert serendipity.verify(task, twice).verdict == "refuted"
