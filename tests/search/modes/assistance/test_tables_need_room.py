"""Where memory has no room for a table, what is asked of it is found without one."""

import numpy as np
import pytest

import serendipity
from search.modes.assistance.distances import closure
from search.modes.assistance.distances.closure import Arc, Closure, ClosureTooLargeError
from search.modes.assistance.distances.perimeter import PackedPlaces, ball_around
from search.packed.cost_vector import ACTIONS_BITS
from search.packed.packed_task import PackedGoal
from serendipity.model import Deadline, LimitReachedError
from serendipity_testing.cases import case_5


class Full(Deadline):
    """No memory is left for anything that is asked for."""

    def require(self, size: float) -> None:
        """See :class:`Deadline`."""
        raise LimitReachedError("memory-limit")


def line(length: int) -> tuple[list[Arc], PackedGoal, int]:
    """Steps from 0 to ``length - 1``, one after another; the last one is the goal."""
    mask = (1 << length.bit_length()) - 1
    arcs = [Arc(PackedGoal(mask, at, ()), ~mask, at + 1, (1 << ACTIONS_BITS) + 1) for at in range(length - 1)]
    return arcs, PackedGoal(mask, length - 1, ()), mask


def test_without_room_for_a_ball_all_states_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(closure, "SMALL", 1)
    arcs, goal, mask = line(40)
    fields = {mask: list(range(40))}
    for deadline in (Deadline(), Full()):
        assert Closure(arcs, goal, fields, 1000, deadline).key(0) == 39 * ((1 << ACTIONS_BITS) + 1)
    with pytest.raises(ClosureTooLargeError):
        Closure(arcs, goal, fields, 39, Full()).key(0)


def test_a_ball_asks_for_all_it_may_touch() -> None:
    arcs, goal, mask = line(40)
    fields = {mask: list(range(40))}
    assert ball_around(arcs, goal, fields, 0, Deadline()) is not None
    assert ball_around(arcs, goal, fields, 0, Full()) is None
    assert PackedPlaces(arcs, fields, 0, Deadline()).item == np.dtype(np.uint32).itemsize


@pytest.mark.parametrize("ties", ["optimistic", "robust", "expected"])
def test_answers_are_the_same_without_tables(ties: str, monkeypatch: pytest.MonkeyPatch) -> None:
    full = serendipity.plan(case_5(), mode="assistance", ties=ties)
    monkeypatch.setattr(closure, "SMALL", 1)
    monkeypatch.setattr("search.modes.assistance.distances.perimeter._LARGE", 0)
    answer = serendipity.plan(case_5(), mode="assistance", ties=ties, deadline=Full())
    assert (answer.status, answer.bounds) == (full.status, full.bounds)
