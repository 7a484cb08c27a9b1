"""What was observed in time: posteriors and plans are proved, and refuted once anything is changed."""

from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from serendipity.model import Condition, Result, Script, Task, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.oracle.observed import costs_of_observed
from serendipity_testing.strategies.time import tasks_in_time
from tests.verify.scenarios.edit import Edit, assert_refuted, certified, edit

WAYS = {
    "go h a b": "a -> b !a @ 1 [2]",
    "go h a c": "a -> c !a @ 6",
    "enter h": "b open -> c !b @ 2",
    "go h b d": "b -> d !b @ 3",
    "show h": "b shown -> c !b @ 1",
    "clear r": " -> shown @ 1 [3]",
}
SHOP = build(init="a", goal="c", actions=WAYS).with_script(Script(facts=[(6, "open")]))
"""It opens with epoch 6; who is at the door before waits, unless a robot shows another way in."""

GOALS = [{"name": name, "goal": [name]} for name in "cd"]
FIRST = "statistics.recognition.goals.0"


def answered(task: Task = SHOP, *seen: str, **options: object) -> Result:
    """The answer to two goals of who has begun something."""
    return serendipity.plan(task, goals=GOALS, observed=list(seen), discount=0.5, **options)


def test_what_was_begun_is_proved() -> None:
    found = answered(SHOP, "go h a b")
    assert [(one.name, one.human_plan) for one in found.goals or ()] == [
        ("c", ("go h a b", "enter h")),
        ("d", ("go h a b", "go h b d")),
    ]
    certificate = serendipity.verify(SHOP, found)
    assert certificate.verdict == "proved", certificate
    assert all(claim.verdict != "refuted" for claim in serendipity.check(SHOP, found).claims)


@pytest.mark.parametrize("options", [{"waiting_cost": 1}, {"head_start": 2}, {"human_model": "observant"}])
def test_who_has_one_goal_left_is_proved(options: dict[str, object]) -> None:
    """Waiting is paid for in what was observed, too; and the head start comes before it."""
    found = serendipity.plan(SHOP, goals=GOALS[:1], observed=["go h a b"], **options)
    assert found.recognition is not None and found.recognition.explained
    assert serendipity.verify(SHOP, found).verdict == "proved"


def test_who_is_in_the_middle_of_something_goes_on_with_it_before_a_head_start() -> None:
    session = serendipity.Session(SHOP)
    session.execute(["go h a b"])
    asked = {"goals": GOALS[:1], "observed": ["enter h"], "head_start": 1}
    found = serendipity.plan(session.task, **asked, waiting_cost=1)
    assert found.human_entries == ((7, "enter h"),)
    assert serendipity.verify(session.task, found).verdict == "proved"


def test_what_waiting_costs_is_for_one_goal_without_a_script_too() -> None:
    plain = build(init="a", goal="c", actions=WAYS)
    with pytest.raises(UsageError, match="waiting_cost: in time"):
        answered(plain, waiting_cost=1)


def test_waiting_counts_for_what_was_observed() -> None:
    said = serendipity.plan(SHOP, goals=GOALS[:1], observed=["go h a b"], waiting_cost=1, nobody_pays=False)
    assert said.recognition is not None
    (only,) = said.recognition.goals
    right = costs_of_observed(SHOP, Condition((SHOP.facts.index("c"),)), ["go h a b"], Fraction(1))
    assert (only.with_observed, only.without_observed) == right == (7, 6)
    assert serendipity.verify(SHOP, said).verdict == "proved"


DOCTORED: dict[str, tuple[Edit, str]] = {
    "a cost": (edit(f"{FIRST}.cost_with_observed", 4.0), "cost with the observations is 3.0"),
    "a cost without": (edit(f"{FIRST}.cost_without_observed", 3.0), "without the observations is 6.0"),
    "a plan": (edit(f"{FIRST}.plan", ["go h a b", "show h"]), "not the canonical one"),
    "a part of what was begun": (edit("statistics.recognition.observed", ["go h a b 2"]), "does alone"),
    "waiting": (edit("statistics.recognition.observed", ["~noop"]), "does alone"),
    "a robot's": (edit("statistics.recognition.observed", ["clear r"]), "does alone"),
    "another": (edit("statistics.recognition.observed", ["go h a c"]), "with the observations is 6.0"),
    "a posterior": (edit(f"{FIRST}.posterior", 0.25), "the posterior is"),
    "a head start": (edit("options.head_start", 1), "head start"),
    "an action without a time": (
        edit("statistics.goals.0.human_plan", ["go h a b", "enter h", "enter h"]),
        "expected 3 starts, got 2",
    ),
    "an epoch": (edit("statistics.goals.0.human_plan_times.starts", [2, 7]), "not the optimal plan"),
}


@pytest.mark.parametrize("way", DOCTORED)
def test_it_is_refuted_once_changed(way: str) -> None:
    change, words = DOCTORED[way]
    assert_refuted(certified(SHOP, answered(SHOP, "go h a b"), change), "replay", words)


@pytest.mark.long
@settings(max_examples=settings().max_examples // 2)
@given(tasks_in_time(), st.randoms(use_true_random=False), st.sampled_from([0, 0, "0.5"]))
def test_whatever_was_observed_is_proved(task: Task, dice: Random, price: object) -> None:
    task = replace(task, robot_goal=Condition(), known_variables=task.variables)
    own = [task.actions[i].name for i in task.human_actions]
    goals = [{"name": fact, "goal": [fact]} for fact in task.facts[:3]]
    seen = [dice.choice(own) for _ in range(dice.choice((1, 2)))] if own else []
    try:
        answer = serendipity.plan(task, goals=goals, observed=seen, waiting_cost=price)
    except UsageError:
        return  # what a plan reaches does not last, or waiting costs over several goals
    certificate = serendipity.verify(task, answer)
    assert certificate.verdict == "proved", certificate
