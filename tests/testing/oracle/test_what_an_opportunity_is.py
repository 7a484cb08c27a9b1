"""What the oracle calls an opportunity (semantics 3.1)."""

from hypothesis import given

from serendipity.testing.oracle import best
from serendipity.testing.strategies import Call, calls


@given(calls(modes=("serendipity", "communication"), ties=False))
def test_an_opportunity_is_cheaper_and_anything_else_is_the_human_plan(call: Call) -> None:
    optimum = best(call.task, call.options, call.human_plan)
    if optimum.saving is None or optimum.cost is None:
        return
    if optimum.opportunity:
        assert optimum.saving > 0
    else:
        assert optimum.saving == 0
        assert optimum.window is None
