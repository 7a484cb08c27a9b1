"""Before the human's first touch, no way on is cheaper than the bound that asks who helps."""

import pytest
from hypothesis import given

from search import PreparedTask
from search.call.context import SearchContext
from search.packed.cost_vector import INFINITE_KEY
from search.spaces.factory import free_bounds
from serendipity.facade.planning import plan
from serendipity.model import Options, Task
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.builders import task, usar
from serendipity_testing.strategies import family_tasks, strips_tasks, tasks
from tests.shortest import distances

_DISCOUNTED = Options(mode="composite", discount="0.9", horizon="inf")  # type: ignore[arg-type]


def relays() -> list[Task]:
    """Buildings in which robots may pass a kit on to each other."""
    chain, ring = "a-b b-c c-d d-e", "a-b b-c c-d d-a"
    return [
        usar(chain, human="e", robots={"rob": "b", "bot": "d"}, kits={"k": "a"}, triage="e"),
        usar(ring, human="c", robots={"rob": "a", "bot": "a"}, kits={"k": "@rob"}, triage="d"),
    ]


ASKED_OTHERWISE = {"steps", "untouched", "touches"}
"""Attributes of ``Bounds`` that are not a bound on the key increment from any packed state."""


class Graph:
    """States that one action after another leads to, and the exact keys to and from them."""

    def __init__(self, context: SearchContext) -> None:
        successors = context.successors()
        first = context.packed.init
        self.edges: dict[int, list[tuple[int, int, bool]]] = {}
        pending, seen = [first], {first}
        while pending:
            state = pending.pop()
            self.edges[state] = []
            for option in (*successors.human(state), *successors.joint(state), *successors.robots(state)):
                if option.actions:
                    after = state & option.keep | option.put
                    his = bool(option.agents & context.packed.human_bit)
                    interaction = his and context.interactions.is_interaction(option.actions[0])
                    self.edges[state].append((option.weight, after, interaction))
                    if after not in seen:
                        seen.add(after)
                        pending.append(after)
        moves = {
            at: [(w, to) for w, to, interaction in out if not interaction] for at, out in self.edges.items()
        }
        self.spent = distances({first}, moves)
        before: dict[int, list[tuple[int, int]]] = {at: [] for at in self.edges}
        for at, out in self.edges.items():
            for weight, to, _ in out:
                before[to].append((weight, at))
        goals = {at for at in self.edges if all(goal.holds(at) for goal in context.goals)}
        self.rest = distances(goals, before)


def assert_admissible(task: Task, options: Options, over: int | None) -> int:
    """How many states the bound tells something about."""
    context = SearchContext(PreparedTask(task), options, Deadline())
    graph = Graph(context)
    best = graph.rest.get(context.packed.init, INFINITE_KEY)
    limit = INFINITE_KEY if over is None else best + context.keys.of_action(context.packed.costs[-1]) * over
    bounds = free_bounds(context, None, limit, idle=False)
    told = 0
    for state, spent in graph.spent.items():
        rest = graph.rest.get(state, INFINITE_KEY)
        bound = bounds.untouched(0, state, spent, ())
        assert bound <= rest or spent + rest >= limit
        told += bounds.private(state) < bound < INFINITE_KEY
    always = {name: bound for name, bound in bounds._asdict().items() if name not in ASKED_OTHERWISE}
    assert {"private", "team"} <= always.keys()
    for state, rest in graph.rest.items():  # what holds whether anybody has helped or not
        for name, bound in always.items():
            assert bound(state) <= rest, f"Bounds.{name} exceeds an exact distance"
    return told


@pytest.mark.parametrize("over", [None, 0, 2])
@pytest.mark.parametrize("number", [0, 1])
def test_bound_holds_where_kits_are_passed_on(number: int, over: int | None) -> None:
    assert assert_admissible(relays()[number], _DISCOUNTED, over) >= (10 if over is None else 0)


@pytest.mark.long
@pytest.mark.parametrize("discount", ["0", "0.9", "1"])
def test_bound_holds_on_random_tasks(discount: str) -> None:
    @given(tasks() | strips_tasks() | family_tasks())
    def law(task: Task) -> None:
        options = _DISCOUNTED.but(discount=discount)
        for over in (None, 1):
            assert_admissible(task, options, over)

    law()


def test_a_robot_that_holds_nothing_does_not_make_help_free() -> None:
    task = relays()[0]
    context = SearchContext(PreparedTask(task), _DISCOUNTED, Deadline())
    ids = {fact: i for i, fact in enumerate(task.facts)}
    left, holds = {ids["at k a"], ids["at rob b"]}, {ids["has rob k"], ids["has_medkit rob"], ids["at rob a"]}
    state = context.packed.pack(task.init - left | holds)
    bounds = free_bounds(context, None, INFINITE_KEY, idle=False)
    # From a, where rob has got the kit, to the human in e.
    walk = 4 * context.weights.robots[0]
    assert bounds.untouched(0, state, 0, ()) == bounds.private(state) + walk


def test_what_two_robots_have_lifted_one_of_them_may_carry_on():
    lifted = task(
        agents="bot hum rob",
        human="hum",
        init="rob1",
        goal="at4",
        actions={
            "go01 rob": "rob0 -> rob1 !rob0 @ 0",
            "go10 rob": "rob1 -> rob0 !rob1 @ 0",
            "go10 bot": " -> bot0 @ 0",
            "lift rob bot": "bot0 rob0 -> box @ 0",
            "carry hum rob": "box rob1 -> at2 @ 1",
            "walk2 hum": "at2 -> at3 @ 2",
            "walk3 hum": "at3 -> at4 @ 3",
        },
    )
    answer = plan(lifted, mode="composite", horizon=6)
    assert (answer.status, answer.cost) == ("optimal", 6)
