"""A human's plan may have more steps than Python's stack has room for."""

from typing import Any

import pytest

import serendipity
from serendipity import Task, UsageError
from serendipity_testing.builders import task as build

STEPS = 1_100
"""More than Python allows calls inside each other, which is 1,000."""


def corridor() -> Task:
    """A walk of so many steps, which no robot can make shorter."""
    steps = {f"go{i} h": f"p{i} -> p{i + 1} !p{i}" for i in range(STEPS)}
    return build(goal=f"p{STEPS}", init="p0", actions={**steps, "wave r": "-> waved"})


@pytest.mark.long
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"suffix": "subplan", "window_weight": 0},
        {"preservation": "state"},
        {"human_model": "observant"},
        {"human_model": "local"},
        {"ties": "robust"},
    ],
    ids=str,
)
def test_planning_beside_a_long_plan(options: dict[str, Any]) -> None:
    """It ended with a RecursionError, as soon as the plan was played against a human who replans."""
    result = serendipity.plan(corridor(), discount="0.9", **options)
    assert (result.status, result.cost) == ("optimal", STEPS)
    assert all(result.realised.values())


@pytest.mark.long
def test_plans_of_more_epochs_than_there_may_be_are_refused_in_one_line() -> None:
    given = build(goal="g", actions={"a h": "-> g", "b h": "-> !g", "c r": "-> !g"})
    plan = ["a h", "b h"] * 500_000 + ["a h"]
    with pytest.raises(UsageError, match="1000000 epochs"):
        serendipity.plan(given, human_plan=plan)
