"""What help leaves changed has a price (semantics 12): as brute force has it, and proved."""

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity import Options, Task, UsageError
from serendipity.testing import strategies
from serendipity.testing.builders import task as build
from serendipity.testing.oracle import best
from tests.facade.rooms import rooms

_OPTIONS = st.builds(
    Options,
    mode=st.sampled_from(["serendipity", "serendipity", "communication", "composite"]),
    discount=st.sampled_from(["0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["0", "0.25", "1000"]),
    suffix=st.sampled_from(["replan", "subplan"]),
    leave_free=st.sampled_from([None, "at r*"]),
    leave_price=st.sampled_from(["*=0.31", "at *=0.17, lit *=0.53, *=2.9", "*0*=0.07, *=1.13"]),
)
_KITE = "at kite *=0.5, *=0"


@pytest.mark.long
@given(st.one_of(rooms(), strategies.tasks()), _OPTIONS)
def test_answers_are_those_of_brute_force(task: Task, options: Options) -> None:
    task = replace(task, robot_goal=type(task.goal)(), known_variables=task.variables)
    horizon = 4 if serendipity.plan(task, mode="individual").cost is None else None
    options = options.but(horizon=horizon)
    expected = best(task, options)
    answer = serendipity.plan(task, **{name: getattr(options, name) for name in options.to_dict()})
    if expected.cost is None or expected.objective is None:
        assert answer.status == expected.status
        return
    figures = (answer.status, answer.cost, answer.objective, answer.opportunity)
    assert figures == (expected.status, float(expected.cost), float(expected.objective), expected.opportunity)
    assert serendipity.verify(task, answer).verdict == "proved"


def test_what_is_left_is_told_and_paid_for() -> None:
    answer = serendipity.plan(serendipity.example("flights"), discount="0.9", leave_price=_KITE)
    free = serendipity.plan(serendipity.example("flights"), discount="0.9")
    assert (free.cost, answer.cost, answer.figure("rule_price")) == (10.8, 11.8, 1)
    assert answer.statistics["left"] == {"at kite harbour": 0.5, "at kite ridge": 0.5}
    assert "left changed, at a price: at kite harbour (0.5), at kite ridge (0.5)" in str(answer)


@pytest.mark.parametrize(("name", "by"), [("cost", 0.5), ("objective", 0.5), ("saving", 0.5)])
def test_edited_figures_are_refuted(name: str, by: float) -> None:
    task = serendipity.example("flights")
    answer = serendipity.plan(task, discount="0.9", leave_price=_KITE)
    told = replace(answer, **{name: getattr(answer, name) + by})
    assert serendipity.verify(task, told).verdict == serendipity.check(task, told).verdict == "refuted"


def test_a_dearer_answer_is_refuted() -> None:
    """Doing nothing, where help pays with what it leaves; and help, where with that it does not."""
    task = serendipity.example("flights")
    nothing = serendipity.plan(task, discount="0.9", leave_price="at kite *=9, *=0")
    assert not nothing.opportunity
    options = nothing.options.but(leave_price=_KITE)
    assert serendipity.verify(task, replace(nothing, options=options)).verdict == "refuted"
    helped = serendipity.plan(task, discount="0.9", leave_price=_KITE)
    told = replace(helped, cost=28.8, objective=1028.8, lower_bound=1028.8, saving=-10.8)
    assert serendipity.verify(task, replace(told, options=nothing.options)).verdict == "refuted"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"leave_price": "at *"}, "leave_price: expected patterns such as dirty"),
        ({"leave_price": "at *=-1"}, r"leave_price: at \*: expected at least 0, got -1"),
        ({"leave_price": "at *=x"}, r"leave_price: at \*: "),
        ({"leave_price": 3}, "leave_price: expected patterns with prices"),
        ({"leave_price": "*=1", "mode": "composite", "horizon": "inf"}, "leave_price: needs a horizon"),
    ],
)
def test_what_is_no_price_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        serendipity.plan(serendipity.example("flights"), **options)


@pytest.mark.parametrize("mode", ["serendipity", "communication"])
def test_what_a_given_plan_wastes_is_told_where_something_is_put_back(mode: str) -> None:
    task = build(
        init="home",
        goal="done",
        actions={
            "long h": " -> done @ 9",
            "short h": " -> done @ 8",
            "quick h": "open -> done @ 1",
            "wait h": " -> waited @ 0",
            "go r": "home -> away !home @ 0",
            "open r": "away -> open",
            "back r": "away -> home !away @ 0",
        },
    )
    answer = serendipity.plan(
        task, mode=mode, human_plan=["wait h", "wait h", "long h"], leave_price="home=2, *=0.5"
    )
    assert answer.statistics["left"] == {"open": 0.5}
    assert (answer.cost, answer.saving, answer.saving_alone) == (2.5, 6.5, 1)
    assert serendipity.verify(task, answer).verdict == "proved"


def messy() -> Task:
    """The human's plan is dearer than a way that leaves a mess; what a robot opens makes possible a third."""
    return build(
        goal="done",
        actions={
            "long h": " -> done @ 9",
            "short h": " -> done mess @ 8",
            "quick h": "open -> done @ 8.2",
            "open r": " -> open @ 0",
        },
    )


def test_what_the_human_would_do_alone_has_no_price() -> None:
    """They gain 1 alone, whatever they leave then; help that costs 8.7 is no match for that."""
    options = Options(discount="1", window_weight=0, leave_price="mess=3, *=0.5")
    answer = serendipity.plan(
        messy(), human_plan=["long h"], discount="1", window_weight=0, leave_price="mess=3, *=0.5"
    )
    assert (answer.cost, answer.opportunity, answer.saving_alone) == (9, False, 1)
    plan = (next(i for i, action in enumerate(messy().actions) if action.name == "long h"),)
    expected = best(messy(), options, plan)
    assert (expected.cost, expected.opportunity, expected.saving_alone) == (9, False, 1)
    assert serendipity.verify(messy(), answer).verdict == "proved"


def test_a_price_that_makes_help_a_tie_is_proved() -> None:
    """Joint plans of the same total were refuted: without the price of what they leave they would be help."""
    built = build(
        agents="hum bot",
        human="hum",
        init="at0",
        goal="at2",
        actions={
            "open0 bot": "-> open0 tired",
            "stroll0 hum": "-> at1 !at0",
            "walk1 hum": "at1 -> at2 !at1 @ 3 | open0 -> at2 !at1 @ 3",
        },
    )
    asked = {"discount": "0.9", "window_weight": 0, "leave_price": "*=0.3"}
    for mode in ("composite", "communication", "serendipity"):
        answer = serendipity.plan(built, mode=mode, **asked)
        assert (answer.cost, answer.saving, answer.opportunity) == (4, 0, False)
        assert serendipity.verify(built, answer).verdict == "proved"
        for told in (replace(answer, saving=0.5), replace(answer, opportunity=True)):
            assert serendipity.verify(built, told).verdict == "refuted"
