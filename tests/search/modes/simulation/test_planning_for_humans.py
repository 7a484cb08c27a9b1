"""Options, edge cases and proofs of planning under a human model."""

from collections.abc import Set
from typing import Any

import pytest

import serendipity
from serendipity import UsageError
from serendipity_testing.builders import task
from serendipity_testing.cases import CASE_3_PLAN, case_1, case_3, case_4, case_8
from tests.search.exact_answers import proved

MODELS = ["observant", "local"]


def _everything(agent: int, fact: int, state: Set[int]) -> bool:
    return True


@pytest.mark.parametrize("model", MODELS)
def test_no_plan_alone_is_infeasible(model: str) -> None:
    result = serendipity.plan(case_8(), human_model=model)
    assert (result.status, result.reason) == ("infeasible", "no-human-plan")


@pytest.mark.parametrize("model", MODELS)
def test_given_plan_that_he_would_drop(model: str) -> None:
    """The human takes the short way as soon as they look up, without any help."""
    built = task(
        goal="p", init="a", actions={"do1 h": "a -> b !a @ 2", "do2 h": "b -> p", "short h": "a -> p"}
    )
    result = serendipity.plan(built, human_model=model, human_plan=["do1 h", "do2 h"])
    assert result.saving_alone == 2.0
    assert not result.opportunity
    assert [step.action for step in result.plan] == ["do1 h", "do2 h"]
    assert serendipity.verify(built, result).verdict != "refuted"


@pytest.mark.parametrize("model", MODELS)
def test_robots_goal_out_of_reach(model: str) -> None:
    built = task(goal="p", robot_goal="z", actions={"do h": "-> p", "x r": "-> q", "y r": "q -> z"})
    result = serendipity.plan(built, human_model=model)
    assert (result.status, result.reason) == ("infeasible", "no-plan-within-horizon")


def test_case_3_both_ways_are_as_long_so_he_keeps_to_his() -> None:
    result = serendipity.plan(case_3(), discount=0.9, human_model="observant", human_plan=CASE_3_PLAN)
    assert not result.opportunity


def test_ties_under_a_local_human_are_those_of_the_paper() -> None:
    """The human does not see that the kit is gone, so via r they are met; via s they are not."""
    costs = {
        ties: serendipity.plan(case_4(), discount=0.9, human_model="local", ties=ties).cost
        for ties in ("fixed", "optimistic", "robust", "expected")
    }
    assert costs == {"fixed": 6.2, "optimistic": 6.2, "robust": 8.0, "expected": 7.1}


def test_max_cost_leaves_doing_nothing() -> None:
    result = serendipity.plan(case_1(), discount=0.9, human_model="observant", max_cost=8)
    assert (result.status, result.cost, result.opportunity) == ("optimal", 10.0, False)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"mode": "composite", "human_model": "local"}, "human_model: 'local' is for serendipity mode only"),
        ({"human_model": "observant", "horizon": 9}, "horizon: expected at least 10"),
        ({"human_model": "observant", "visible": _everything}, "visible: is for human_model 'local' only"),
    ],
)
def test_what_does_not_go_together_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        serendipity.plan(case_1(), **options)


def test_a_local_human_who_sees_everything_is_observant() -> None:
    result = serendipity.plan(case_4(), discount=0.9, human_model="local", visible=_everything)
    assert (result.cost, result.realised) == (8.0, {"observant": True, "local": True})


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("chat", ["-> told", "met ->"])
def test_what_keeps_him_busy_for_nothing_is_a_help(model: str, chat: str) -> None:
    """It contributes to no goal, so it was left out; meanwhile the other robot does the human's work."""
    built = task(
        agents="h r q",
        init="met",
        goal="done",
        actions={"do h": "-> done @ 5", "chat h r": f"{chat} @ 0", "do q": "-> done @ 2"},
    )
    result = proved(built, human_model=model)
    assert (result.cost, result.opportunity) == (2.0, True)
