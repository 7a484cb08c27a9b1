"""What an answer over ties saves is counted from what robots pay by themselves for goals of their own."""

from dataclasses import replace

import pytest

import serendipity
from serendipity.testing.builders import task as build


@pytest.mark.parametrize("ties", ["optimistic", "robust", "expected"])
def test_savings_beside_robots_goals(ties: str) -> None:
    task = build(
        goal="g",
        robot_goal="q",
        actions={"do h": "-> g @ 5", "quick h": "q -> g @ 1", "see to it r": "-> q @ 2"},
    )
    asked = {"mode": "communication", "horizon": 2, "ties": ties}
    right = serendipity.plan(task, **asked)  # type: ignore[arg-type]
    assert (right.cost, right.saving) == (3.0, 4.0)
    assert serendipity.verify(task, right).verdict == "proved"
    assert serendipity.verify(task, replace(right, saving=2.0)).verdict == "refuted"
    early = replace(right, status="feasible", saving=2.0)
    assert serendipity.verify(task, early).verdict == "refuted"
