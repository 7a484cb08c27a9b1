"""Robots that have to leave things as they would be (semantics 12), while it happens."""

from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity import Condition, Task, UsageError
from serendipity.testing import strategies
from serendipity.testing.builders import task as build


@pytest.mark.long
@given(
    strategies.tasks(),
    st.sampled_from(["omniscient", "observant", "local"]),
    st.sampled_from(["at*", "none", "*0*"]),
)
def test_nothing_is_left_and_nobody_pays(task: Task, human: str, free: str) -> None:
    assume(not task.robot_goal and serendipity.plan(task, mode="individual").cost is not None)
    (run,) = serendipity.execute(task, human, discount="0.9", leave_free=free).rows
    assert run.reached and run.left == 0
    assert run.alone is not None and run.human_cost <= run.alone


def test_the_cart_is_brought_back() -> None:
    task = serendipity.example("parcels")
    runs = {
        free: serendipity.execute(task, "omniscient", discount="0.9", leave_free=free).rows[0]
        for free in ("*", "at *", None, "nothing")
    }
    assert [float(f"{run.cost:.6g}") for run in runs.values()] == [8.5, 8.6, 8.7, 8.8]
    assert {run.human_cost for run in runs.values()} == {8}


def test_robots_with_goals_of_their_own_leave_what_these_ask_for() -> None:
    task = serendipity.example("parcels")
    own = task.with_goal(task.goal, Condition((task.facts.index("at cart mill"),)))
    (run,) = serendipity.execute(own, "omniscient", discount="0.9").rows
    assert run.reached


def test_what_somebody_wants_is_not_put_back() -> None:
    """Goals were contradictory: the crate brought and at home, or a cup that only a robot gives, and not."""
    fetch = {"go h": "a -> b !a", "fetch r": "home -> crate !home", "back r": "crate -> home !crate"}
    give = {"give h r": "desk -> cup", "drop r": "tray -> floor !tray", "pick r": "floor -> tray !floor"}
    for task in (
        build(agents="h r", human="h", init="a home", goal="b", robot_goal="crate", actions=fetch),
        build(agents="h r", human="h", init="desk tray", goal="cup", actions=give),
    ):
        (run,) = serendipity.execute(task, "omniscient", discount="0.9", leave_free="nothing").rows
        assert (run.reached, run.left) == (True, 0)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"goals": [{"name": "a", "goal": ["at parcel inn"]}]}, "leave_free: goes with a known goal only"),
        ({"leave_free": 3}, "leave_free: expected patterns apart by commas"),
    ],
)
def test_what_it_does_not_go_with_is_refused(more: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        serendipity.execute(serendipity.example("parcels"), **{"leave_free": "at *", **more})
