"""Laws of semantics 3 that the oracle's answers obey on random calls."""

from dataclasses import replace
from fractions import Fraction

from hypothesis import given

from serendipity.testing.oracle import best
from serendipity.testing.strategies import Call, calls


@given(calls(modes=("serendipity",), ties=False))
def test_weight_0_costs_what_composite_costs(call: Call) -> None:
    """With K = 0 the window [1, T+1) fits every plan (semantics 3.1); a given plan need not be beaten."""
    if call.human_plan is not None:
        return
    free = call.options.but(window_weight=0, max_window=None, max_cost=None, preservation="kernel")
    serendipity = best(call.task, free, call.human_plan)
    if serendipity.status == "infeasible" or call.task.goal.holds(call.task.init):
        return  # nothing to preserve, or no epoch in which a window could start
    composite = best(call.task, free.but(mode="composite"), call.human_plan)
    assert serendipity.cost == composite.cost


@given(calls(modes=("communication",), ties=False))
def test_free_communication_is_composite(call: Call) -> None:
    """With weight 0 and no prefix to keep (semantics 3.4)."""
    talk = call.options.but(communication_weight=0, keep_prefix=False)
    communication = best(call.task, talk, call.human_plan)
    composite = best(call.task, talk.but(mode="composite"), call.human_plan)
    assert communication == composite


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


@given(calls(modes=("serendipity",), ties=False))
def test_a_higher_discount_never_costs_more(call: Call) -> None:
    """Without K's preference for short windows, cheaper robots can only help."""
    free = call.options.but(window_weight=0, max_cost=None)
    dear = best(call.task, free.but(discount=Fraction(1, 4)), call.human_plan)
    cheap = best(call.task, free.but(discount=Fraction(3, 4)), call.human_plan)
    if dear.cost is not None:
        assert cheap.cost is not None
        assert cheap.cost <= dear.cost


@given(calls(modes=("composite",), ties=False))
def test_more_time_never_costs_more(call: Call) -> None:
    optimum = best(call.task, call.options, call.human_plan)
    endless = best(call.task, call.options.but(horizon="inf"), call.human_plan)
    if optimum.cost is not None:
        assert endless.cost is not None
        assert endless.cost <= optimum.cost


@given(calls(ties=False))
def test_renumbering_the_agents_changes_nothing(call: Call) -> None:
    """Agents' ids carry no meaning."""
    task = call.task
    last = len(task.agents) - 1
    actions = tuple(
        replace(action, participants=tuple(sorted(last - who for who in action.participants)))
        for action in task.actions
    )
    mirrored = replace(task, agents=task.agents[::-1], human=last - task.human, actions=actions)
    assert best(mirrored, call.options, call.human_plan) == best(task, call.options, call.human_plan)
