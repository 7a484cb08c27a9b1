"""Laws hold for brute force and for the planner, and each finds planners that break it."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import pytest
from hypothesis import given, settings

import serendipity
from serendipity.model import Options, Result, UsageError, Window
from serendipity.testing.asking import settled
from serendipity.testing.call import Call
from serendipity.testing.cases import case_2
from serendipity.testing.laws import LAWS, Answered
from serendipity.testing.oracle import Optimum, best
from serendipity.testing.strategies import calls


def by_brute_force(call: Call) -> Optimum:
    return best(call.task, call.options, call.human_plan)


def by_planner(call: Call) -> Result:
    options = {field.name: getattr(call.options, field.name) for field in fields(Options)}
    return serendipity.plan(call.task, human_plan=call.human_plan_names, **options)


def askable(call: Call) -> Call | None:
    """With the human's plan and the horizon filled in; None where it has none."""
    try:
        by_brute_force(call)
        return settled(call)
    except UsageError:
        return None


@pytest.mark.parametrize("law", LAWS)
@given(call=calls(ties=False))
@settings(max_examples=settings.default.max_examples // 6)
def test_brute_force_obeys(law: str, call: Call) -> None:
    asked = askable(call)
    if asked is not None:
        assert list(LAWS[law](asked, by_brute_force)) == []


@pytest.mark.parametrize("law", LAWS)
@given(call=calls(ties=False))
@settings(max_examples=settings.default.max_examples // 10)
def test_the_planner_obeys(law: str, call: Call) -> None:
    asked = askable(call)
    if asked is not None:
        assert list(LAWS[law](asked, by_planner)) == []


@dataclass
class Said:
    cost: Any
    objective: Any = None
    window: Window | None = None

    def __post_init__(self) -> None:
        self.objective = self.cost if self.objective is None else self.objective


def robots_get_dearer(call: Call) -> Answered:
    return Said(10 + call.options.discount)


def patience_costs(call: Call) -> Answered:
    horizon = call.options.horizon
    return Said(100 if horizon == "inf" else horizon)


def weight_is_a_gain(call: Call) -> Answered:
    return Said(5, 2000 - call.options.window_weight, Window(1, 2))


def weight_makes_plans_cheap(call: Call) -> Answered:
    return Said(2000 - call.options.window_weight, 3000, Window(1, 2))


def teams_are_dear(call: Call) -> Answered:
    return Said(20 if call.options.mode == "composite" else 10)


def windows_matter_always(call: Call) -> Answered:
    return Said(9 if call.options.mode == "composite" else 10)


def names_matter(call: Call) -> Answered:
    return Said(len(call.task.agents[call.task.human]))


def numbers_matter(call: Call) -> Answered:
    return Said(call.task.human)


def heads_are_counted(call: Call) -> Answered:
    return Said(len(call.task.agents))


def a_fee_is_added(call: Call) -> Answered:
    return Said(1 + call.task.actions[0].cost)


def actions_are_counted(call: Call) -> Answered:
    return Said(len(call.task.actions))


LIARS: tuple[tuple[str, Callable[[Call], Answered]], ...] = (
    ("discount", robots_get_dearer),
    ("horizon", patience_costs),
    ("window weight", weight_is_a_gain),
    ("window weight", weight_makes_plans_cheap),
    ("modes", teams_are_dear),
    ("free windows", windows_matter_always),
    ("free words", teams_are_dear),
    ("renaming", names_matter),
    ("renaming", numbers_matter),
    ("idle robot", heads_are_counted),
    ("scale", a_fee_is_added),
    ("split cost", actions_are_counted),
)


@pytest.mark.parametrize(("law", "liar"), LIARS, ids=lambda value: getattr(value, "__name__", value))
def test_each_finds_who_breaks_it(law: str, liar: Callable[[Call], Answered]) -> None:
    asked = {"split cost": {"mode": "composite", "horizon": "inf"}, "free words": {"mode": "composite"}}
    options = Options(**asked.get(law, {}))
    assert list(LAWS[law](settled(Call(case_2(), options)), liar))


def test_there_is_a_liar_for_every_law() -> None:
    assert {law for law, _ in LIARS} == {*LAWS}
