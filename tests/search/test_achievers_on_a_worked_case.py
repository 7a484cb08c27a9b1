"""The corridor in the docstring of the achiever automaton, figure by figure."""

import pytest

from search.bounds.achiever_automaton import AchieverAutomaton
from search.bounds.interactions import Need
from search.call.prepared_task import PreparedTask, TaskTables
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline
from serendipity.testing.builders import task

OPEN, OPEN_AND_IN_A = 0, 1


def corridor(robots: str) -> TaskTables:
    """Rooms a - b - c; robot r starts in a, robot s in c, where the door can be opened for 2."""
    actions = {"leave h": "open ra -> away"}
    for robot in robots.split():
        for here, there in ("ab", "ba", "bc", "cb"):
            actions[f"go-{here}{there} {robot}"] = f"{robot}{here} -> {robot}{there} !{robot}{here}"
        actions[f"open {robot}"] = f"{robot}c !open -> open @ 2"
    built = task(
        agents=f"h {robots}",
        init=" ".join({"r": "ra", "s": "sc"}[robot] for robot in robots.split()),
        goal="away",
        actions=actions,
    )
    return PreparedTask(built).plain(Deadline())


def literal(packed: PackedTask, fact: str) -> tuple[int, int]:
    """A fact's variable and value."""
    return packed.fact_bits[packed.task.facts.index(fact)]


def explored(tables: TaskTables) -> AchieverAutomaton:
    """The automaton of the door, costs not scaled."""
    packed, transitions = tables.packed, tables.robots.transitions(Deadline())
    (door, is_open), (place, in_a) = literal(packed, "open"), literal(packed, "ra")
    needs = [(OPEN, Need(door, is_open)), (OPEN_AND_IN_A, Need(door | place, is_open | in_a))]
    weights = [int(cost) for cost in packed.costs]
    automaton = AchieverAutomaton(packed, transitions, door, needs, weights, (), Deadline())
    automaton.explore(lambda _: True)
    return automaton


@pytest.mark.parametrize(
    ("robots", "expected"), [("r s", {OPEN: 2, OPEN_AND_IN_A: 2}), ("r", {OPEN: 4, OPEN_AND_IN_A: 6})]
)
def test_costs_from_the_initial_state(robots: str, expected: dict[int, int]) -> None:
    tables = corridor(robots)
    automaton = explored(tables)
    assert automaton.cost == expected
    for need, cost in expected.items():
        assert automaton.distances(need, 100)(tables.packed.init) == cost


def test_distances_from_other_states() -> None:
    tables = corridor("r")
    costs, packed = explored(tables).distances(OPEN_AND_IN_A, 100), tables.packed
    place, in_c = literal(packed, "rc")
    assert costs(packed.init & ~place | in_c) == 4
