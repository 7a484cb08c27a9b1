"""What an explanation says that actions wait for: without it they would begin sooner."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity import Explanation, PlanError, Script, Task, UsageError
from serendipity.explanation.waiting import Wait, waits
from serendipity.model import TimedPlan
from serendipity.testing.builders import task
from serendipity.testing.call import Call
from serendipity.testing.strategies import bystander_tasks, calls_in_time, corridor_tasks, scripted_tasks
from tests.explanation.meal import meal


def told(found: Explanation) -> list[str]:
    return [text for topic, text in found.sentences if topic == "waiting"]


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
