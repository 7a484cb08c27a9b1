"""The planner gives the figures of semantics 9 and of the paper's own examples (semantics 5)."""

import pytest

import serendipity
from serendipity import UsageError, Window
from serendipity_testing.builders import task as build
from serendipity_testing.cases import WORKED, Worked, case_8
from tests.search.exact_answers import proved

EXAMPLES = [
    # medkit1 in, mode, discount, cost, window start
    ("room2", "serendipity", "0.6", 12.6, 6),
    ("room2", "serendipity", "0.9", 11.4, 6),
    ("room2", "serendipity", "0.5", 13.0, None),
    ("room2", "communication", "0.6", 12.6, None),
    ("room2", "communication", "0.9", 11.4, None),
    ("room7", "serendipity", "0.6", 13.0, None),
    ("room7", "serendipity", "0.9", 13.0, None),
    ("room7", "serendipity", "1", 13.0, None),
    ("room7", "communication", "0.6", 12.6, None),
    ("room7", "communication", "0.9", 11.4, None),
    ("room5", "serendipity", "0.6", 13.0, None),
    ("room5", "serendipity", "0.9", 11.5, 5),
    ("room5", "communication", "0.9", 11.4, None),
]


@pytest.mark.parametrize("worked", [pytest.param(w, id=str(w)) for w in WORKED])
def test_worked_case(worked: Worked) -> None:
    result = serendipity.plan(worked.task(), human_plan=worked.human_plan, **worked.options)
    assert result.cost == (None if worked.cost is None else float(worked.cost))
    assert result.window == (None if worked.window is None else Window(*worked.window))
    assert result.opportunity == worked.opportunity
    assert result.status == ("infeasible" if worked.cost is None else "optimal")


def test_case_8_communication_needs_a_horizon() -> None:
    with pytest.raises(UsageError, match="horizon"):
        serendipity.plan(case_8(), mode="communication")


@pytest.mark.parametrize(("room", "mode", "discount", "cost", "start"), EXAMPLES)
def test_paper_example(room: str, mode: str, discount: str, cost: float, start: int | None) -> None:
    result = serendipity.plan(serendipity.example(room), mode=mode, discount=discount)
    assert (result.cost, result.human_cost, result.opportunity) == (cost, 13.0, cost < 13)
    if start is not None:
        assert result.window == Window(start, start + 1)


def test_what_is_announced_does_not_hide_what_costs_less() -> None:
    """What the human announces counts more and costs less: only with that it stays within 3."""
    actions = {"own h": "-> g @ 10", "prepare h": "-> p @ 2", "make r": "-> p @ 3", "end r": "p -> g"}
    task = build(goal="g", actions=actions)
    asked = {"mode": "communication", "communication_weight": 1, "horizon": 2}
    result = proved(task, max_cost=3, **asked)
    assert (result.cost, result.objective) == (3.0, 5.0)


def test_where_a_robot_is_counts_for_what_it_does_after_something_that_it_does_anywhere() -> None:
    """The robot opens during the first step, and prepares wherever it is: the human can jump."""
    actions = {
        "walk0 h": "-> at1",
        "walk1 h": "at1 -> at2",
        "walk2 h": "at2 -> at3 @ 2",
        "jump h": "at2 open -> at3 @ 0.5",
        "open r": "-> open",
        "prepare r": "at1 -> at2 @ 0",
    }
    task = build(goal="at3", actions=actions)
    result = proved(task)
    assert (result.cost, result.objective) == (2.5, 1002.5)
