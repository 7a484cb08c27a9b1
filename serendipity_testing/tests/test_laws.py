"""Laws hold for brute force and for the planner, and each finds planners that break it."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import pytest
from hypothesis import given, settings

import serendipity
from serendipity.model import Options, Result, UsageError, Window
from serendipity_testing.asking import settled
from serendipity_testing.call import Call
from serendipity_testing.cases import case_2
from serendipity_testing.laws import LAWS
from serendipity_testing.oracle import Optimum, best
from serendipity_testing.strategies import calls


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


LIARS: tuple[tuple[str, str, Callable[[Call], Said]], ...] = (
    ("discount", "robots get dearer", lambda call: Said(10 + call.options.discount)),
    (
        "horizon",
        "patience costs",
        lambda call: Said(100 if call.options.horizon == "inf" else call.options.horizon),
    ),
    ("window weight", "is a gain", lambda call: Said(5, 2000 - call.options.window_weight, Window(1, 2))),
    (
        "window weight",
        "makes plans cheap",
        lambda call: Said(2000 - call.options.window_weight, 3000, Window(1, 2)),
    ),
    ("modes", "teams are dear", lambda call: Said(20 if call.options.mode == "composite" else 10)),
    ("free windows", "they matter", lambda call: Said(9 if call.options.mode == "composite" else 10)),
    ("free words", "teams are dear", lambda call: Said(20 if call.options.mode == "composite" else 10)),
    ("renaming", "names matter", lambda call: Said(len(call.task.agents[call.task.human]))),
    ("renaming", "numbers matter", lambda call: Said(call.task.human)),
    ("idle robot", "heads are counted", lambda call: Said(len(call.task.agents))),
    ("scale", "a fee is added", lambda call: Said(1 + call.task.actions[0].cost)),
    ("split cost", "actions are counted", lambda call: Said(len(call.task.actions))),
)


@pytest.mark.parametrize(("law", "lie", "liar"), LIARS)
def test_each_finds_who_breaks_it(law: str, lie: str, liar: Callable[[Call], Said]) -> None:
    asked = {"split cost": {"mode": "composite", "horizon": "inf"}, "free words": {"mode": "composite"}}
    options = Options(**asked.get(law, {}))
    assert list(LAWS[law](settled(Call(case_2(), options)), liar))


def test_there_is_a_liar_for_every_law() -> None:
    assert {law for law, *_ in LIARS} == {*LAWS}
