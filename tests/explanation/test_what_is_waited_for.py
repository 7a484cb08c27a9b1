"""What an explanation says that actions wait for: without it they would begin sooner.

And of people who replan: when they change their mind, and what hinges on what robots do.
"""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import serendipity
from serendipity import Explanation, PlanError, Script, Task, UsageError
from serendipity.explanation.person import PlayedAnswer
from serendipity.explanation.waiting import Wait, waits
from serendipity.model import Deadline, TimedPlan
from serendipity_testing.builders import Builder, task
from serendipity_testing.call import Call
from serendipity_testing.generator.in_time import random_call_in_time
from serendipity_testing.strategies import bystander_tasks, calls_in_time, corridor_tasks, scripted_tasks


def told(found: Explanation, topic: str = "waiting") -> list[str]:
    return [text for about, text in found.sentences if about == topic]


def altered(built: Task, wait: Wait, *, left_out: bool = False) -> Task:
    """The task in which what is waited for comes an epoch sooner, or not at all."""
    facts, deeds, init = [*built.script.facts], [*built.script.deeds], built.init
    for one in built.script.facts:
        name = f"{'' if one.true else '!'}{built.facts[one.fact]}"
        if wait.why == "fact" and (name, one.epoch) == (wait.cause, wait.until):
            facts.remove(one)
            if one.epoch > 1:
                facts.append(replace(one, epoch=one.epoch - 1))
            else:
                init = init | {one.fact} if one.true else init - {one.fact}
    for deed in built.script.deeds:
        if wait.why == "bystander" and (deed.name, deed.end) == (wait.cause, wait.until):
            deeds.remove(deed)
            deeds += [] if left_out else [replace(deed, epoch=deed.epoch - 1)]
    script = replace(built.script, facts=tuple(facts), deeds=tuple(deeds))
    return replace(built.at(init), script=script)


def begun(built: Task, epoch: int, name: str) -> int:
    """The epoch in which the human begins an action, if it is not that one."""
    plan = serendipity.plan(built, mode="individual")
    starts = plan.human_plan_times.starts if plan.human_plan_times else range(1, len(plan.human_plan) + 1)
    return next(start for start, action in zip(starts, plan.human_plan, strict=True) if action == name)


@pytest.mark.long
def test_a_morning() -> None:
    built = serendipity.example("morning")
    found = serendipity.explain(built, discount=0.5)
    assert told(found) == [
        "ann: 'dress ann' begins in epoch 4, at 6, and no sooner: awake ann becomes true at 6.",
        "ann: 'wash ann' begins in epoch 10, at 18, and no sooner: hot-water becomes true at 18.",
    ]
    for wait in found.waits:
        assert begun(altered(built, wait), wait.epoch, wait.action) == wait.epoch - 1
    data = found.to_dict()
    assert data["epoch"] == 2
    assert [one["until"] for one in data["waits"]] == [3, 9]


def test_a_head_start_and_what_it_is_worth() -> None:
    found = serendipity.explain(meal(), discount="0.9", head_start=2)
    assert told(found) == [
        "h: 'fetch h' begins in epoch 3, at 2, and no sooner: the head start is over at 2.",
        "Without the head start help would save 0 instead of 1.9.",
    ]
    assert not serendipity.plan(meal(), discount="0.9").opportunity
    again = serendipity.explain(meal(), found.answer)
    assert again.sentences == found.sentences


def test_a_plan_that_is_given_with_waiting() -> None:
    built = task(goal="done", actions={"do h": " -> done @ 2", "help r": " -> done @ 1"})
    found = serendipity.explain(built, human_plan=[(3, "do h")])
    assert told(found) == ["h: 'do h' begins in epoch 3, at 2, and no sooner: the plan has it so."]
    assert serendipity.plan(built, human_plan=[(2, "do h")]).opportunity


@pytest.mark.parametrize(
    ("actions", "cause"),
    [
        ({"go h": "!busy -> done", "use r": "-> busy", "leave r": "busy -> !busy"}, "leave r"),
        ({"go h": "open -> done", "use r": "-> x", "leave r": "-> open [2]"}, "leave r"),
    ],
)
def test_a_bystander(actions: dict[str, str], cause: str) -> None:
    init = "busy" if "busy" in actions["go h"] else ""
    built = task(init=init, goal="done", actions=actions)
    built = built.with_script(Script(people={"r": [(1, "use r"), (4, "leave r")]}))
    (wait,) = serendipity.explain(built).waits
    assert (wait.why, wait.cause, wait.action) == ("bystander", cause, "go h")
    assert begun(altered(built, wait), wait.epoch, "go h") == wait.epoch - 1


def plays(built: Task, plan: TimedPlan) -> bool:
    try:
        built.replay_alone(plan)
    except PlanError:
        return False
    return True


@given(
    st.one_of(
        calls_in_time(modes=("individual",), of=of)
        for of in (None, scripted_tasks(of=corridor_tasks()), bystander_tasks())
    )
)
def test_without_what_it_waits_for_an_action_begins_sooner(call: Call) -> None:
    asked = call.keywords() | {"interference": "paper"}
    try:
        answer = serendipity.plan(call.task, human_plan=call.human_entries, **asked)
    except (UsageError, PlanError):
        return
    if answer.human_entries is None or answer.human_plan_times is None:
        return
    plan = call.task.plan_from_names(answer.human_entries)
    starts, length = call.task.starts_of(plan), call.task.epochs_of(plan)
    for wait in waits(call.task, answer):
        sooner = TimedPlan(plan, [start - (start == wait.epoch) for start in starts], length)
        assert plays(call.task, sooner) == (wait.why in ("plan", "head-start"))
        if wait.why == "fact":
            assert plays(altered(call.task, wait), sooner)
        elif wait.why == "bystander":
            without = altered(call.task, wait, left_out=True)
            assert plays(without, sooner) or plays(altered(call.task, wait), sooner)


def test_a_single_step_disappears() -> None:
    about = task(
        init="a", goal="d", actions={"far h": "a -> d !a @ 3", "near h": "a c -> d !a @ 1", "aid r": "-> c"}
    )
    said = [
        text
        for topic, text in serendipity.explain(
            about, serendipity.plan(about, discount=1, horizon=2)
        ).sentences
        if topic == "help"
    ]
    assert said[0] == "Of the plan of h, step 1 disappears: far h."


def meal() -> Task:
    """As in worked case 5 of semantics 10.5: a robot two moves away brings what somebody would fetch."""
    return task(
        init="far",
        goal="full",
        actions={
            "fetch h": " -> food @ 3",
            "eat h": "food -> full @ 1",
            "come r": "far -> near !far @ 1",
            "bring r": "near -> food @ 10",
        },
    )


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
def test_a_morning_with_somebody_who_replans() -> None:
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
@settings(suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow])  # few calls have help
@given(st.integers(0, 10**6), st.sampled_from(["0.5", "0.9"]))
def test_what_hinges_on_robots_is_what_happens_otherwise(seed: int, discount: str) -> None:
    """Without robots it is the answer with idle robots, and no turn is for nothing."""
    call = random_call_in_time(seed)
    try:
        answer = serendipity.plan(call.task, human_model="observant", discount=discount)
    except (UsageError, PlanError):
        assume(False)
    assume(answer.opportunity)
    played = PlayedAnswer(call.task, answer, Deadline())
    assert [float(cost) for cost in played.alone().costs] == [answer.human_cost]
    assert played.alone().as_planned
    for turn in played.turns():
        assert turn.because or turn.why == "joins"
        assert turn.why == "joins" or turn.kept is None or turn.best < turn.kept
