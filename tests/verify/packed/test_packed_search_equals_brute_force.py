"""Packed states, exclusive facts, bounds and cheapest paths, against plain sets and dictionaries."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis.strategies import sampled_from

from serendipity.model import Deadline, Task, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.generator.families import family_task
from serendipity_testing.oracle import best
from serendipity_testing.strategies import Call, calls, tasks
from tests.shortest import distances
from verify.base.execution import State, after, applicable, states_of_pi_h
from verify.base.individual import IndividualOptimum
from verify.base.optimal_plans import OptimalPlans
from verify.calls.solve import solve
from verify.limits import limited
from verify.packed import operators as packed
from verify.packed.mutexes import ReachablePairs
from verify.packed.operators import FAR, PackedOperator
from verify.packed.problem import PackedProblem, StateSpace

FAMILY = [
    *((name, seed, size) for name, size in (("blocks", 3), ("logistics", 2)) for seed in range(4)),
    *(("switches", seed, 6) for seed in range(4)),
]


def reached(task: Task) -> list[State]:
    """All states that one action after another leads to."""
    found = {task.init: None}
    for state in (queue := [task.init]):
        for action in task.actions:
            if applicable(action, state):
                new = after(state, action)
                if new not in found:
                    found[new] = None
                    queue.append(new)
        if len(found) > 3000:
            pytest.skip("too many states to enumerate")
    return list(found)


def team_problem(task: Task) -> PackedProblem:
    """Everybody's actions, one after the other, by their costs in units."""
    space = StateSpace(len(task.facts), task.init, task.actions, Deadline())
    operators = [PackedOperator(a.pre, a.neg, a.add, a.delete, int(a.cost * 1000) + 1) for a in task.actions]
    goal = task.goal.positive, task.goal.negative
    return PackedProblem(space, range(len(task.facts)), operators, goal, Deadline())


def from_goals(task: Task, states: list[State]) -> dict[State, int]:
    """Least weights to the goal."""
    into: dict[State, list[tuple[int, State]]] = {state: [] for state in states}
    for state in states:
        for a in task.actions:
            if applicable(a, state):
                into[after(state, a)].append((int(a.cost * 1000) + 1, state))
    return distances(filter(task.goal.holds, states), into)


def agree(task: Task) -> None:
    """Bounds never exceed the distances, and cheapest paths are as cheap, from every state."""
    states = reached(task)
    expected = from_goals(task, states)
    pairs = ReachablePairs(len(task.facts), task.init, task.actions, Deadline())
    assert all(pairs.possible(state) for state in states)
    problem = team_problem(task)
    rows = problem.pack(states)
    assert rows is not None
    kept = set(problem.layout.place)
    for row, state in zip(rows, states, strict=True):
        assert problem.layout.facts_of(row) == state & kept
    bounds = problem.bounds(rows)
    for bound, state in zip(bounds.tolist(), states, strict=True):
        assert bound <= expected.get(state, FAR)
    for state, row in list(zip(states, rows, strict=True))[:: max(1, len(states) // 7)]:
        start = row[None, :]
        assert problem.least(start) == expected.get(state)
        if state in expected:
            assert problem.least(start, expected[state]) is None
            assert problem.least(start, expected[state] + 1) == expected[state]


@given(tasks())
def test_in_random_tasks(task: Task) -> None:
    agree(task)


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_in_families(name: str, seed: int, size: int) -> None:
    agree(family_task(name, seed, size))


@given(tasks(), sampled_from((1, 10, packed._AT_ONCE)))
def test_successors_are_those_of_sets(task: Task, at_once: int) -> None:
    problem = team_problem(task)
    states = reached(task)[:50]
    rows = problem.pack(states)
    assert rows is not None
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(packed, "_AT_ONCE", at_once)
        by, chosen = problem.table.applicable(rows)
    new = problem.table.after(rows[by], chosen)
    found = {(int(k), problem.layout.facts_of(row)) for k, row in zip(by, new, strict=True)}
    kept = set(problem.layout.place)
    assert found == {
        (k, after(state, action) & kept)
        for k, state in enumerate(states)
        for action in task.actions
        if applicable(action, state)
    }


def test_what_is_looked_at_for_many_states_takes_little_memory() -> None:
    """1.6 million operators that a state may allow by one of two values, and each does not by the other."""
    deeds = {f"do{number} h": "p q -> done" for number in range(200)}
    task = build(goal="done", actions={**deeds, "begin r": "-> p", "go r": "-> q"})
    problem = team_problem(task)
    row = problem.pack([frozenset({task.facts.index("p")})])
    assert row is not None
    tracemalloc.start()
    try:
        by, _ = problem.table.applicable(np.repeat(row, 8192, axis=0))
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(by) == 2 * 8192 and peak < 2**24


def test_what_excludes_each_other_is_a_field() -> None:
    blocks = family_task("blocks", 1, 4)
    problem = team_problem(blocks)
    assert max(len(field.facts) for field in problem.layout.fields) > 3


def test_a_state_that_cannot_be_reached_is_not_packed() -> None:
    blocks = family_task("blocks", 1, 4)
    assert team_problem(blocks).pack([frozenset(range(len(blocks.facts)))]) is None


def test_several_starts_share_a_search() -> None:
    blocks = family_task("blocks", 2, 3)
    problem, states = team_problem(blocks), reached(blocks)
    expected = from_goals(blocks, states)
    starts = [state for state in states if state in expected][:40]
    paid = np.array([(7 * k) % 50 * 100 for k in range(len(starts))], np.int64)
    rows = problem.pack(starts)
    assert rows is not None
    search, found = problem.search(rows, paid)
    assert found is not None
    assert search.paid(found) == min(int(p) + expected[state] for p, state in zip(paid, starts, strict=True))


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_what_an_optimal_plan_teaches_is_what_a_search_finds(name: str, seed: int, size: int) -> None:
    task = family_task(name, seed, size)
    plan = OptimalPlans(task).canonical()
    if plan is None:
        return
    learned = IndividualOptimum(task)
    learned.learn(plan)
    for state in states_of_pi_h(task, plan, Deadline()):
        assert learned.optimum(state) == IndividualOptimum(task).optimum(state)


@pytest.mark.long
def test_whole_answers_with_better_bounds() -> None:
    """Programs decide nothing here, and better bounds are made as soon as there are two states."""
    decided = 0

    @given(calls(modes=("serendipity", "communication", "composite")))
    def law(call: Call) -> None:
        nonlocal decided
        try:
            optimum = best(call.task, call.options, call.human_plan)
        except UsageError:
            return
        with limited(few_states=1, methods=("-programs",)):
            result = solve(call.task, call.options, human_plan=call.human_plan_names, method="auto")
        assert result.status in (optimum.status, "unknown")
        if result.status == "optimal" and call.options.ties == "fixed":
            assert result.objective == float(optimum.objective or 0)
            decided += 1

    law()
    assert decided


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_a_plan_that_is_supposed_to_be_optimal(name: str, seed: int, size: int) -> None:
    """It is believed only if nothing is cheaper."""
    task = family_task(name, seed, size)
    plan = OptimalPlans(task).canonical()
    if not plan:
        return
    expected = IndividualOptimum(task).optimum(task.init)
    supposed = IndividualOptimum(task)
    supposed.suppose(plan)
    assert supposed.optimum(task.init) == expected
    for there in task.human_actions:
        state = after(task.init, task.actions[there])
        for back in task.human_actions:
            both = applicable(task.actions[there], task.init) and applicable(task.actions[back], state)
            if both and after(state, task.actions[back]) == task.init:
                dearer = IndividualOptimum(task)
                dearer.suppose((there, back, *plan))
                assert dearer.optimum(task.init) == expected
                return
