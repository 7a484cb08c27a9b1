"""Looking ops up finds all that are applicable, in their order."""

from hypothesis import given

from search.modes.assistance.distances.watched import Watched
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from serendipity.model import Task
from serendipity.model.resources.deadline import Deadline
from tests.search.modes.assistance.strategies import games
from tests.search.small_tasks import reached


@given(task=games())
def test_every_applicable_op_is_a_candidate(task: Task) -> None:
    packed = PackedTask(task, frozenset(), Deadline())
    ops = packed.own + packed.others
    watched = Watched(packed, ops, Deadline())
    for state in reached(packed, ops):
        expected = [op for op in ops if applicable(op, state)]
        assert [op for op in watched.candidates(state) if applicable(op, state)] == expected
