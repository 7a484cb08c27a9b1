"""Where robots are in nobody's way, and what the human never gets away from."""

import pytest

from search.packed.operators import asked_by
from search.short_windows.independent.short_windows import are_apart
from search.short_windows.question import lost_values
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.builders import task as build
from tests.search.small_tasks import packed_of


def test_two_values_of_a_field_that_must_not_be() -> None:
    """The field is asked for once: a sum of its masks is another field."""
    places = "abcd"
    actions = {f"go_{a}{b} r": f"at_{a} -> at_{b} !at_{a}" for a in places for b in places if a != b}
    task = build(init="at_a", goal="done", actions=actions | {"watch h": "!at_a !at_b -> done"})
    packed = packed_of(task)
    (watch,) = packed.own
    assert len(watch.forbidden) == 2
    assert asked_by(watch) == packed.outside
    assert not are_apart(packed, Deadline(), strict=False)


@pytest.mark.parametrize(("strict", "apart"), [(False, False), (True, True)])
def test_a_robot_that_takes_away_what_is_in_use(strict: bool, apart: bool) -> None:
    """The human goes through while the robot shuts the door: after that epoch they could not have."""
    actions = {
        "through h": "door -> end @ 1",
        "around h": "-> end @ 5",
        "shut r": "door -> !door warm @ 1",
        "heat h": "end -> warm @ 3",
    }
    packed = packed_of(build(init="door", goal="end warm", actions=actions))
    assert are_apart(packed, Deadline(), strict=strict) == apart


def test_values_from_which_there_is_no_way_back() -> None:
    """The human does not unload what a robot has loaded."""
    task = build(
        init="at_a",
        goal="at_c",
        actions={
            "carry_b h": "at_a -> at_b !at_a",
            "carry_c h": "at_b -> at_c !at_b",
            "load r": "at_a -> in_r !at_a",
            "unload r": "in_r -> at_c !in_r",
        },
    )
    packed = packed_of(task)
    (lost,) = lost_values(packed).values()
    assert lost == {packed.fact_bits[task.facts.index("in_r")][1]}  # type: ignore[index]
