"""The checker proves what the search answers, and refutes answers that were tampered with."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity import Result, Task
from serendipity.model import Deadline, Options, Policy
from serendipity.model.answers.answer import PolicyBounds
from serendipity.model.numbers import as_written
from serendipity_testing.builders import task
from serendipity_testing.cases import case_5, case_6
from tests.search.modes.assistance.strategies import games
from tests.verify.claims import verdicts
from verify.policy import check_policy

TIES = ("optimistic", "fixed", "robust", "expected")


@given(task=games(), ties=st.sampled_from(TIES), no_block=st.booleans())
def test_answers_are_proved(task: Task, ties: str, no_block: bool) -> None:
    result = serendipity.plan(task, mode="assistance", ties=ties, no_block=no_block)
    claims = ["replay", "cost", "optimal", "lower_bound"]
    expected = ["infeasible"] if result.status == "infeasible" else claims
    assert verdicts(serendipity.verify(task, result)) == dict.fromkeys(expected, "proved")


@pytest.mark.parametrize("ties", TIES)
def test_what_only_joint_actions_ask_for_tells_no_states_apart(ties: str) -> None:
    """They are nobody's move.  What is free, and changes nothing else, was done first."""
    actions = {"both h r": "!x -> goal", "free r": "-> x @ 0", "help r": "-> goal"}
    game = task(agents="h r", human="h", goal="goal", actions=actions)
    result = serendipity.plan(game, mode="assistance", ties=ties)
    assert [decision.action for decision in result.policy.decisions] == ["help r"]
    assert set(verdicts(serendipity.verify(game, result)).values()) == {"proved"}


def idle(result: Result, policy: Policy) -> Result:
    """The same answer with a policy that does nothing, and every figure as if that were the best."""
    cost = result.human_cost
    value = as_written(cost), Fraction(0)
    return replace(
        result,
        policy=policy,
        plan=None,
        agent_costs=dict.fromkeys(result.agent_costs, 0.0) | {"h": cost},
        cost=cost,
        objective=cost,
        lower_bound=cost,
        saving=0.0,
        opportunity=False,
        bounds=PolicyBounds(value, value),
    )


@given(task=games(), ties=st.sampled_from(TIES))
def test_idle_policy_is_proved_only_where_it_is_optimal(task: Task, ties: str) -> None:
    result = serendipity.plan(task, mode="assistance", ties=ties)
    if result.human_cost is None or result.status == "infeasible":
        return
    forged = idle(result, replace(result.policy, decisions=()))
    found = verdicts(serendipity.verify(task, forged))
    assert (found["replay"], found["cost"]) == ("proved", "proved")
    assert found["optimal"] == ("proved" if forged.agent_costs == result.agent_costs else "undecided")


@given(task=games(), data=st.data())
def test_floors_above_the_value_are_not_believed(task: Task, data: st.DataObject) -> None:
    """Raised floors must not make doing nothing pass for optimal where help is better."""
    result = serendipity.plan(task, mode="assistance", ties="expected")
    if result.status == "infeasible" or result.human_cost is None or result.saving == 0:
        return
    step = Fraction(data.draw(st.integers(1, 3)))
    raised = tuple(
        replace(floor, value=(floor.value[0] + step, floor.value[1])) for floor in result.policy.floors
    )
    assert verdicts(serendipity.verify(task, idle(result, Policy((), raised))))["optimal"] != "proved"


def tampered(policy: Policy, i: int, **changes: object) -> Policy:
    decisions = list(policy.decisions)
    decisions[i] = replace(decisions[i], **changes)
    return replace(policy, decisions=tuple(decisions))


def refuted(task: Task, result: Result, policy: Policy) -> str:
    """The text of the claim that is refuted."""
    claims = check_policy(task, replace(result, policy=policy), Deadline())
    return next(claim.reason for claim in claims if claim.verdict == "refuted")


@pytest.mark.parametrize("ties", TIES)
def test_wrong_value_is_refuted(ties: str) -> None:
    result = serendipity.plan(case_6(), mode="assistance", ties=ties)
    wrong = tampered(result.policy, 0, value=(Fraction(0), Fraction(1)))
    assert "make (0, 2)" in refuted(case_6(), result, wrong)


@pytest.mark.parametrize(
    ("number", "action", "words"),
    [(0, "carry s a g", "can't do 'carry s a g'"), (1, "noop", "for ever"), (1, None, "idles")],
    ids=["impossible action", "waiting for ever", "missing state"],
)
def test_wrong_decisions_are_refuted(number: int, action: str | None, words: str) -> None:
    result = serendipity.plan(case_6(), mode="assistance")
    wrong = replace(result.policy, decisions=result.policy.decisions[:number])
    if action is not None:
        wrong = tampered(result.policy, number, action=action)
    assert words in refuted(case_6(), result, wrong)


def test_blocking_is_refuted_where_it_is_forbidden() -> None:
    result = serendipity.plan(case_6(), mode="assistance")
    strict = replace(result, options=result.options.but(no_block=True))
    assert "without a plan" in refuted(case_6(), strict, result.policy)


def infeasible() -> Result:
    """The false answer that case 5 has none."""
    return Result(
        "assistance",
        "infeasible",
        "p",
        Options(mode="assistance"),
        reason="no-plan",
        bounds=PolicyBounds((Fraction(0), Fraction(0)), None),
    )


def test_false_infeasibility_is_refuted() -> None:
    assert verdicts(serendipity.verify(case_5(), infeasible()))["infeasible"] == "refuted"


def test_plan_must_be_a_run_of_the_policy() -> None:
    result = serendipity.plan(case_5(), mode="assistance")
    late = replace(result, plan=tuple(replace(step, epoch=step.epoch + 1) for step in result.plan))
    assert "would not wait" in refuted(case_5(), late, late.policy)


@pytest.mark.parametrize("ties", TIES)
def test_check_walks_through_the_policy(ties: str) -> None:
    result = serendipity.plan(case_6(), mode="assistance", ties=ties)
    assert verdicts(serendipity.check(case_6(), result)) == {
        "replay": "proved",
        "cost": "proved",
        "optimal": "not_in_scope",
        "lower_bound": "not_in_scope",
    }
    wrong = replace(result, policy=tampered(result.policy, 0, value=(Fraction(0), Fraction(1))))
    assert serendipity.check(case_6(), wrong).verdict == "refuted"


def test_check_says_what_it_did_not_examine() -> None:
    (claim,) = serendipity.check(case_5(), infeasible()).claims
    assert (claim.claim, claim.verdict) == ("infeasible", "not_in_scope")
    assert "verify" in claim.reason
