"""The human's private variables are tabulated together only as far as that does not take long."""

import pytest
from hypothesis import given

import search.human.pattern_database
import search.human.whole_actions
from search import prepare, solve
from search.human.pattern_database import partial_graph, private_fields, whole_graph
from search.kernel.library import library
from search.packed.packed_task import PackedTask
from serendipity.facade.call import options_from
from serendipity.model import Deadline, Task
from serendipity_testing.builders import task
from serendipity_testing.countdown import Countdown
from serendipity_testing.strategies import Call, calls, family_tasks, tasks
from tests.search.exact_answers import assert_answered
from tests.search.small_tasks import tower

COUNT = 30


def packed(problem: Task) -> PackedTask:
    return PackedTask(problem, frozenset(), Deadline())


def test_too_many_states_are_not_listed_again_and_again() -> None:
    """With one variable less each time, 50,000 states were listed for each of 15 numbers of switches."""
    names = [f"on{i}" for i in range(COUNT)]
    actions = {f"switch{name} h": f"-> {name}" for name in names} | {"help r": "-> on0"}
    deadline = Countdown(10**9)
    problem = packed(task(goal=" ".join(names), actions=actions))
    assert whole_graph(problem, deadline) is None
    graph = partial_graph(problem, deadline)
    assert 10_000 <= len(graph.moves) <= 50_000
    assert 10**9 - deadline.left_over[0] < 60_000


def test_what_can_only_become_little_together_is_kept_together() -> None:
    chain = {f"do{i} h": f"f{i} -> f{i + 1} @ 2" for i in range(COUNT)} | {"help r": "-> light"}
    problem = packed(task(init="f0", goal=f"f{COUNT} light", actions=chain))
    graph = whole_graph(problem, Deadline())
    assert graph.mask == sum(private_fields(problem))
    assert len(graph.moves) == COUNT + 1


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
@pytest.mark.parametrize("call", [{"mode": "individual"}, {"mode": "composite", "horizon": "inf"}, {}])
def test_the_kernel_plans_where_not_all_can_be_kept(call: dict[str, str]) -> None:
    """Distances in some of the private variables were all there was: no plan, and no proof."""
    deadline = Countdown(15_000)
    lamp = {"shine r": "-> light", "look h": "light -> seen @ 0.1", "search h": "-> seen @ 3"}
    built = tower("abcdefgh", "h", goal="seen", more=lamp)
    *_, last = solve(prepare(built, deadline), options_from(call), deadline=deadline)
    assert last.status == "optimal"


def test_answers_are_the_same_where_none_can_be_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search.human.pattern_database, "_MAX_STATES", 1)
    monkeypatch.setattr(search.human.pattern_database, "_FEW_STATES", 1)

    @given(calls(ties=False, of=tasks() | family_tasks()))
    def law(call: Call) -> None:
        assert_answered(call)

    law()
