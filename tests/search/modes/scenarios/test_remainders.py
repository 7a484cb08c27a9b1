"""What is known of a scenario that goes on for certain is handed on with its epochs, where it does go on."""

import pytest

from search.modes.scenarios.remainder import Remainder
from serendipity.model.task.plans import Step, Window


@pytest.mark.parametrize(
    ("window", "inside", "goes_on"),
    [
        (None, False, True),
        (None, True, False),
        (Window(2, 3), False, True),
        (Window(2, 3), True, False),
        (Window(1, 3), True, True),
        (Window(1, 3), False, False),
        (Window(1, 2), True, False),  # a limit came, and then another plan was found: its window is over
    ],
)
def test_only_a_window_that_is_where_the_scenario_is_goes_on(
    window: Window | None, inside: bool, goes_on: bool
) -> None:
    found = Remainder(5, 5, (Step(1, 0), Step(2, 1)), window)
    assert found.goes_on(1, inside=inside) == goes_on
    if goes_on:
        assert found.after(2) == Remainder(3, 3, found.steps, window)
