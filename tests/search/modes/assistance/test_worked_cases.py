"""semantics 9, cases 5 and 6, and what mode ``assistance`` refuses."""

from fractions import Fraction

import pytest

import serendipity
from serendipity import Result, UsageError
from serendipity.cli.text.answers import policy_lines
from serendipity_testing.builders import task
from serendipity_testing.cases import case_5, case_6, case_8
from tests.search.exact_answers import proved


def pair(result: Result) -> tuple[str, str]:
    assert result.status == "optimal"
    assert result.bounds.lower == result.bounds.upper
    return tuple(map(str, result.bounds.lower))


@pytest.mark.parametrize(
    ("ties", "value"),
    [("optimistic", ("1", "1")), ("fixed", ("1", "1")), ("robust", ("2", "0")), ("expected", ("3/2", "1/2"))],
)
def test_case_5(ties: str, value: tuple[str, str]) -> None:
    assert pair(serendipity.plan(case_5(), mode="assistance", ties=ties)) == value


def test_case_5_ends_right_after_the_carry() -> None:
    result = serendipity.plan(case_5(), mode="assistance")
    assert [(step.epoch, step.action) for step in result.plan] == [(1, "walk p a b"), (2, "carry s b d")]


@pytest.mark.parametrize("ties", ["optimistic", "fixed", "robust", "expected"])
def test_case_6(ties: str) -> None:
    assert pair(serendipity.plan(case_6(), mode="assistance", ties=ties)) == ("0", "2")
    assert pair(serendipity.plan(case_6(), mode="assistance", ties=ties, no_block=True)) == ("2", "0")


def test_saving_is_the_humans() -> None:
    result = serendipity.plan(case_6(), mode="assistance")
    assert (result.human_cost, result.saving, result.opportunity) == (2.0, 2.0, True)
    assert list(result.agent_costs.items()) == [("p", 0.0), ("s", 2.0)]


def test_goal_that_holds_costs_nothing() -> None:
    done = task(init="g", goal="g", actions={"do h": "-> g", "undo r": "-> !g"})
    result = serendipity.plan(done, mode="assistance")
    assert pair(result) == ("0", "0")
    assert result.plan == ()


@pytest.mark.parametrize("ties", ["optimistic", "fixed", "robust", "expected"])
def test_nothing_ends_is_infeasible(ties: str) -> None:
    never = task(goal="g", actions={"do h": "x -> g", "help r": "-> y"})
    result = serendipity.plan(never, mode="assistance", ties=ties)
    assert (result.status, result.reason, result.policy) == ("infeasible", "no-plan", None)


def test_supporter_alone_may_reach_the_goal() -> None:
    """The prime waits, at no cost, while they have no plan."""
    helpless = task(goal="g", actions={"open r": "-> x @ 2", "finish r": "x -> g @ 3"})
    result = serendipity.plan(helpless, mode="assistance")
    assert pair(result) == ("0", "5")
    assert (result.opportunity, result.saving) == (False, None)


def test_joint_actions_are_nobodys_move() -> None:
    result = serendipity.plan(case_8(), mode="assistance")
    assert result.status == "optimal"
    assert all(len(step.agents) == 1 for step in result.plan)


def test_two_robots_and_a_given_plan_are_refused() -> None:
    two = task(agents="h r q", goal="g", actions={"do h": "-> g"})
    with pytest.raises(UsageError, match="one robot"):
        serendipity.plan(two, mode="assistance")
    with pytest.raises(UsageError, match="human_plan"):
        serendipity.plan(case_5(), mode="assistance", human_plan=["walk p a b", "walk p b d"])


def test_policy_is_printed_as_a_plan_with_branches() -> None:
    result = serendipity.plan(case_5(), mode="assistance", ties="expected")
    text = "\n".join(policy_lines(case_5(), result))
    assert "walk p a b: go on at" in text
    assert "carry s b d" in text
    assert "p pays 1.5, s pays 0.5 on average; alone p pays 2" in str(result).splitlines()


@pytest.mark.parametrize("ties", ["fixed", "robust", "optimistic", "expected"])
@pytest.mark.parametrize("scale", ["1e99", "1e-99"])
def test_huge_and_tiny_costs_are_told_apart(ties: str, scale: str) -> None:
    """They ran into each other, and a game that ends was said to have no end."""
    dear = Fraction(scale)
    planned = task(
        goal="g",
        actions={
            "walk h": f"-> g @ {3 * dear}",
            "ride h": f"lift -> g @ {dear}",
            "lift r": f"-> lift @ {7 * dear}",
        },
    )
    result = proved(planned, mode="assistance", ties=ties)
    assert result.status == "optimal"
    assert result.agent_costs == {"h": float(dear), "r": float(7 * dear)}
