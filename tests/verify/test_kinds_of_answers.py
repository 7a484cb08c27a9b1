"""What each method says of each kind of answer is what is written down, proof files included."""

from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.model import Task, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_4
from serendipity_testing.generator.calls import random_call
from tests.verify.kinds import alike, kinds, table
from tests.verify.test_ties_share_their_plans import errands
from verify.base.optimal_plans import OptimalPlans
from verify.calls.call import ExaminedCall
from verify.certificate.humans import _out_of_reach
from verify.certificate.reactions import cheapest_reaction


@pytest.mark.long
def test_the_table_is_what_each_method_says_of_each_kind() -> None:
    assert table().strip() == Path(__file__).with_name("kinds.md").read_text().strip()


def test_nothing_is_left_out_of_scope_that_a_proof_needs() -> None:
    for name, good in kinds().items():
        claims = serendipity.verify(good.task, good.result).claims
        assert name == "unknown" or {c.verdict for c in claims if c.claim != "window"} == {"proved"}, name


# -- humans who replan


@pytest.mark.long
@pytest.mark.parametrize("human_model", ["observant", "local"])
def test_what_no_joint_plan_undercuts_nothing_undercuts(human_model: str) -> None:
    """A program of all joint plans bounds what happens with a human who replans: playing finds no less."""
    spared = 0
    for seed in range(60):
        task = random_call(seed).task
        plans = OptimalPlans(task)
        canonical = plans.canonical()
        if canonical is None:
            continue
        answer = serendipity.plan(task, human_model=human_model, discount="0.6", horizon=len(canonical) + 1)
        if answer.cost is None:
            continue
        call = ExaminedCall(task, answer.options, canonical, plans)
        for most in _around(call, answer.cost):
            if _out_of_reach(call, most):
                spared += 1
                assert cheapest_reaction(call, most).status == "none", (seed, most)
    assert spared > 15


def _around(call: ExaminedCall, cost: float) -> tuple[int, int, int]:
    units = round(cost * call.prices.scale)
    return units - 1, units, units + 1


def test_help_that_a_human_does_not_follow_has_to_be_played(tmp_path: Path) -> None:
    """Case 4: a joint plan costs less, and no program says that an observant human is not part of it."""
    answer = serendipity.plan(case_4(), human_model="observant", discount="0.9")
    certificate = serendipity.verify(case_4(), answer, method="program")
    assert (certificate.verdict, certificate.claims[-2].method) == ("proved", "exhaustive")
    with pytest.raises(UsageError, match="where a joint plan costs less than the answer"):
        serendipity.verify(case_4(), answer, proof=tmp_path / "proof.json")
    assert list(tmp_path.iterdir()) == []


# -- proof files


def _two_ways() -> Task:
    return build(
        goal="p",
        actions={"one h": "-> p @ 3", "two h": "-> p @ 3", "three h": "-> p @ 3", "less h": "q -> p"}
        | {"help r": "-> q"},
    )


@pytest.mark.parametrize(
    ("task", "asked", "other"),
    [
        (case_4, {"human_model": "observant", "discount": 0}, {"human_model": "local", "discount": 0.5}),
        (alike, {"horizon": 2, "goals": [{"goal": ["p"]}, {"goal": ["z"]}]}, {"horizon": 2, "discount": 0.5}),
        (_two_ways, {"ties": "robust"}, {"ties": "expected", "horizon": 2, "discount": 0.9}),
        (lambda: errands(3), {"ties": "expected"}, {"ties": "expected", "discount": 0.5}),
        (lambda: errands(3), {"ties": "optimistic", "discount": 0.5}, {"ties": "optimistic"}),
    ],
)
def test_a_proof_is_of_its_own_answer(task: Any, asked: Any, other: Any, tmp_path: Path) -> None:
    file, given = tmp_path / "proof.json", task()
    answer = serendipity.plan(given, **asked)
    assert serendipity.verify(given, answer, proof=file).verdict == "proved"
    assert serendipity.check_proof(file).accepted
    assert serendipity.check_proof(file, given, answer).accepted
    if "goals" in asked:
        other = other | {"goals": asked["goals"]}
    assert not serendipity.check_proof(file, given, serendipity.plan(given, **other)).accepted


def test_what_rules_alone_decide_has_no_file(tmp_path: Path) -> None:
    """It was not written, and nobody said so."""
    nothing = kinds()["goals, none"]
    with pytest.raises(UsageError, match="no programs for an answer that rules alone decide"):
        serendipity.verify(nothing.task, nothing.result, proof=tmp_path / "proof.json")
    assert list(tmp_path.iterdir()) == []


def test_one_program_stands_for_all_plans_that_nothing_helps(tmp_path: Path) -> None:
    """24 optimal plans of the human, and robots of no use beside any of them."""
    file, task = tmp_path / "proof.json", errands(4)
    for ties in ("robust", "optimistic", "expected"):
        answer = serendipity.plan(task, ties=ties)
        assert serendipity.verify(task, answer, proof=file).verdict == "proved"
        found = serendipity.check_proof(file, task, answer)
        assert (found.accepted, len(found.programs)) == (True, 1)
        beside = "pi_H" if ties == "robust" else "beside any of 24 plans"
        assert ties == "robust" or beside in found.programs[0].name
