"""What is said of people who replan: when they change their mind, and what hinges on what robots do."""

from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity import Explanation, Task
from serendipity.explanation.person import Played
from serendipity.model import Deadline, PlanError, UsageError
from serendipity.testing.builders import Builder
from serendipity.testing.generator.in_time import random_call_in_time
from tests.explanation.meal import meal


def told(found: Explanation, topic: str) -> list[str]:
    return [text for about, text in found.sentences if about == topic]


def wood() -> Task:
    """Ann fetches wood from the shed, and goes through the hall, to which a robot may bring it."""
    built = Builder(("ann", "bot"), separator=",")
    for here, there in (("room", "hall"), ("hall", "shed")):
        built.named(f"walk ann {here} {there}", (0,), f"at ann {here}", f"at ann {there}, !at ann {here}")
    for place, cost in (("shed", "5"), ("hall", "1")):
        built.named(f"take ann {place}", (0,), f"at ann {place}, at wood {place}", "warm ann", cost)
    built.named("carry bot", (1,), "at wood shed", "at wood hall, !at wood shed", "2")
    return built.task("at ann room, at wood shed", "warm ann")


def test_what_somebody_finds_where_they_are() -> None:
    found = serendipity.explain(wood(), discount="0.5", human_model="local")
    assert told(found, "person") == [
        "In epoch 2, ann finds at wood hall, not at wood shed (after 'carry bot'), and replans: "
        "the plan works no more, the best from here costs 1; "
        "left out: walk ann hall shed; take ann shed; instead: take ann hall."
    ]


def test_what_somebody_joins_in() -> None:
    found = serendipity.explain(serendipity.example("room2"), discount="0.6", human_model="observant")
    joins, replans = told(found, "person")
    joint = "hand_over robot commx mk2 hall4"
    assert joins == (
        f"In epoch 6, commx sees 'move robot room4 hall4', and joins in '{joint}': "
        "with it commx has 6 to pay from here, alone it would be 8."
    )
    assert replans.startswith(
        f"In epoch 7, after '{joint}', commx replans: 5 from here instead of 8; left out:"
    )
    assert told(found, "without")[0] == (
        "Without any robot, commx would keep to the former plan, and it would cost 13 instead of 12.6."
    )
    sooner, later = told(found, "moment")
    assert "an epoch sooner" in sooner
    assert "'move_reverse robot room4 room3' (epoch 2)" in later
    assert (found.discount.value, found.discount.included) == (Fraction(1, 2), False)
    data = found.to_dict()["reaction"]
    assert [turn["why"] for turn in data["turns"]] == ["joins", "replans"]
    assert {one["change"] for one in data["contrasts"]} == {"without", "sooner", "later"}


def test_why_nothing_helps() -> None:
    found = serendipity.explain(serendipity.example("room5"), discount="0.9", human_model="local")
    assert told(found, "help") == [
        "No help: nothing that robots could do beside commx, who sees what is near and is not told, "
        "costs less than the 13 that commx pays alone."
    ]
    assert "discount" in dict(found.sentences)
    assert {miss.rule: miss.cost for miss in found.misses} == {"prefix": 11.4, "sight": 11.5}
    assert all(miss.departs is not None for miss in found.misses)
    assert found.reaction is None


def test_somebody_gets_up() -> None:
    found = serendipity.explain(meal(), discount="0.9", head_start=2, human_model="observant")
    assert told(found, "person") == [
        "In epoch 3, at 2, h gets up, finds food (after 'bring r'), and replans: "
        "1 from here instead of 4; left out: fetch h."
    ]
    assert told(found, "moment") == [
        "Were any one of 'come r' (epoch 1, at 0); 'bring r' (epoch 2, at 1), with all that robots do "
        "after it, an epoch later, h would keep to the former plan, and it would cost 5.1 instead of 2.1."
    ]
    assert "Without the head start help would save 0 instead of 1.9." in told(found, "waiting")


@pytest.mark.long
def test_a_morning() -> None:
    found = serendipity.explain(serendipity.example("morning"), discount=0.5, human_model="observant")
    assert told(found, "person") == [
        "In epoch 10, at 18, ann sees 'lay-table robi', and replans: 28 from here instead of 32; "
        "left out: lay-table ann.",
        "In epoch 13, at 24, ann sees 'make-coffee robi', and replans: 14 from here instead of 22; "
        "left out: make-coffee ann.",
    ]
    assert "and no sooner: hot-water becomes true at 18" in told(found, "waiting")[1]


def test_a_limit_leaves_topics_out() -> None:
    built = serendipity.example("room2")
    answer = serendipity.plan(built, discount="0.6", human_model="observant")
    found = serendipity.explain(built, answer, time_limit=1e-9)
    assert {"person", "contrast", "discount"} <= set(found.left_out)
    assert "what the human makes of it" in told(found, "limit")[0]


@pytest.mark.long
@given(st.integers(0, 10**6), st.sampled_from(["0.5", "0.9"]))
def test_what_hinges_on_robots_is_what_happens_otherwise(seed: int, discount: str) -> None:
    """Without robots it is the answer with idle robots, and no turn is for nothing."""
    call = random_call_in_time(seed)
    try:
        answer = serendipity.plan(call.task, human_model="observant", discount=discount)
    except (UsageError, PlanError):
        assume(False)
    assume(answer.opportunity)
    played = Played(call.task, answer, Deadline())
    assert [float(cost) for cost in played.alone().costs] == [answer.human_cost]
    assert played.alone().as_planned
    for turn in played.turns():
        assert turn.because or turn.why == "joins"
        assert turn.why == "joins" or turn.kept is None or turn.best < turn.kept
