"""Help that the human notices before they act on it (semantics 14): as brute force has it, and proved."""

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity import Condition, Options, Script, Task, UsageError
from serendipity.testing import strategies
from serendipity.testing.builders import Builder
from serendipity.testing.builders import task as build
from serendipity.testing.oracle import best
from serendipity.testing.strategies.time import tasks_in_time
from tests.facade.rooms import answered, rooms, rooms_in_time

_OPTIONS = st.builds(
    Options,
    discount=st.sampled_from(["0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["0", "0.25", "1000"]),
    interference=st.sampled_from(["paper", "strict"]),
    noticed=st.just(True),
    leave_free=st.sampled_from([None, None, "at *"]),
)


@pytest.mark.long
@given(st.one_of(rooms(timed=False), strategies.tasks()), _OPTIONS)
def test_answers_are_those_of_brute_force(task: Task, options: Options) -> None:
    as_brute_force_has_it(task, options)


_IN_TIME = st.fixed_dictionaries(
    {"head_start": st.sampled_from([0, 0, 0, 1, 2]), "waiting_cost": st.sampled_from(["0", "0", "0.5"])}
)


@pytest.mark.long
@given(st.one_of(rooms(), rooms_in_time(), rooms_in_time(), tasks_in_time()), _OPTIONS, _IN_TIME)
def test_answers_in_time_are_those_of_brute_force(task: Task, options: Options, more: dict[str, Any]) -> None:
    robots = task.with_goal(task.goal, Condition())
    as_brute_force_has_it(robots, options.but(**more))


def as_brute_force_has_it(task: Task, options: Options) -> None:
    """Answer a call as brute force does, and prove it."""
    expected = best(task, options)
    answer = answered(task, options)
    figures = (answer.status, answer.cost, answer.objective, answer.opportunity)
    if expected.cost is None or expected.objective is None:
        assert answer.status == expected.status
        return
    found = (expected.status, float(expected.cost), float(expected.objective), expected.opportunity)
    assert figures == found
    assert serendipity.verify(task, answer).verdict == "proved"


def test_they_do_not_go_for_what_is_brought_elsewhere_at_that_moment() -> None:
    """In ``room5`` they pass by room5 in the epoch in which the robot drops the medkit elsewhere."""
    task = serendipity.example("room5")
    free = serendipity.plan(task, discount="0.9")
    bound = serendipity.plan(task, discount="0.9", noticed=True)
    assert (free.cost, bound.cost, bound.figure("rule_price")) == (11.5, 13, 1.5)
    told = replace(free, options=free.options.but(noticed=True))
    for certificate in (serendipity.verify(task, told), serendipity.check(task, told)):
        assert "noticed (semantics 14): the human has not seen" in str(certificate)


def _lit(epochs: int) -> Task:
    """Work is quick by the lamp of p0, where Ann is until her walk begins; to light it takes some epochs."""
    made = Builder(("ann", "bot"))
    made.named("walk ann p0 p1", (0,), "at_ann_p0", "!at_ann_p0 / at_ann_p1", "1", 2)
    made.named("walk ann p1 p0", (0,), "at_ann_p1", "!at_ann_p1 / at_ann_p0", "1", 2)
    made.named("work ann p1", (0,), "at_ann_p1", "done", "5")
    made.named("work-lit ann p1", (0,), "at_ann_p1 lit_p0", "done", "1")
    made.named("light bot p0", (1,), "", "lit_p0", "1", epochs)
    return made.task("at_ann_p0", "done")


@pytest.mark.parametrize(("epochs", "cost"), [(1, 2.5), (2, 6)])
def test_they_see_what_ends_before_their_walk_begins(epochs: int, cost: float) -> None:
    task = _lit(epochs)
    free = serendipity.plan(task, discount="0.5", window_weight=0)
    bound = serendipity.plan(task, discount="0.5", window_weight=0, noticed=True)
    assert (free.cost, bound.cost) == (2.5, cost)
    told = replace(free, options=bound.options)
    verdict = "proved" if epochs == 1 else "refuted"
    assert serendipity.verify(task, told).verdict == serendipity.check(task, told).verdict == verdict


def test_what_the_script_changes_is_no_news() -> None:
    """The lamp of p0 goes on by itself, which they know; so it is part of their plan alone."""
    task = _lit(2).with_script(Script(facts=[(2, "lit_p0")]))
    answer = serendipity.plan(task, discount="0.5", window_weight=0, noticed=True)
    assert (answer.human_cost, answer.cost) == (2, 2)


def test_who_is_moved_by_others_is_refused() -> None:
    task = _lit(2).with_script(Script(facts=[(1, "!at_ann_p0"), (1, "at_ann_p1")]))
    with pytest.raises(UsageError, match="noticed: where somebody else moves the human"):
        serendipity.plan(task, discount="0.5", window_weight=0, noticed=True)


@pytest.mark.parametrize("ties", ["fixed", "robust"])
def test_who_has_left_their_plan_goes_on_with_what_they_begin(ties: str) -> None:
    """What is due after it has a variant on their plan and one off it; the verifier looked at the first."""
    ways = {"walk h": "-> b !a @ 3", "go h": "b -> c !b [2]", "end h": "c -> d", "jump h": "k -> c"}
    help_ = {"carry h r": "-> b !a", "open r": "-> k"}
    carried = build(agents="h r", human="h", init="a", goal="d", actions=ways | help_)
    answer = serendipity.plan(carried, leave_free="nothing", noticed=True, ties=ties)
    assert (answer.cost, serendipity.verify(carried, answer).verdict) == (3, "proved")


def test_who_passes_by_is_in_nobodys_way() -> None:
    """The bot may work where Ann is on her way to, but not take what she takes up in that epoch."""
    actions = {
        "leave ann": "at_ann_p0 key -> at_ann_p1 !at_ann_p0 @ 1",
        "work ann": "at_ann_p1 -> done @ 5",
        "work-lit ann": "at_ann_p1 lit_p1 -> done @ 1",
        "light bot": "-> lit_p1 @ 1",
        "lose bot": "-> lit_p1 !key @ 0",
    }
    task = build(agents="ann bot", human="ann", init="at_ann_p0 key", goal="done", actions=actions)
    asked = {"discount": "0", "window_weight": 0, "max_disturbance": 0}
    costs = {}
    for interference in ("paper", "strict"):
        answer = serendipity.plan(task, **asked, interference=interference)
        assert serendipity.verify(task, answer).verdict == "proved"
        costs[interference] = answer.cost
    assert costs == {"paper": 2, "strict": 3}


def test_what_effects_cannot_forbid_is_refused() -> None:
    actions = {
        "go ann": "at_ann_p0 !shut -> at_ann_p1 !at_ann_p0 @ 1",
        "work ann": "at_ann_p1 -> done @ 5",
        "work-lit ann": "at_ann_p1 lit_p0 -> done @ 1",
        "light bot": "!shut -> lit_p0 @ 0",
        "shut cat": "-> shut @ 0",
    }
    task = build(agents="ann bot cat", human="ann", init="at_ann_p0", goal="done", actions=actions)
    with pytest.raises(UsageError, match=r"where several ask for a fact to be false \('shut'\) is not known"):
        serendipity.plan(task, discount="0.5", window_weight=0, max_disturbance=0, interference="strict")


def test_what_is_handed_over_needs_no_notice() -> None:
    answer = serendipity.plan(serendipity.example("room2"), discount="0.9", noticed=True)
    assert (answer.cost, answer.statistics["rule_binds"]) == (11.4, False)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"mode": "composite"}, "noticed: goes with mode serendipity only"),
        ({"suffix": "subplan"}, "noticed: goes with suffix replan only"),
    ],
)
def test_what_it_does_not_go_with_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        serendipity.plan(serendipity.example("room2"), noticed=True, **options)
