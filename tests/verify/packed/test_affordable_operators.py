"""Operators that a plan within a limit has are never left out, in every state of small tasks."""

import numpy as np
import pytest
from hypothesis import given

from serendipity.model import Deadline, Options, Task
from serendipity.testing.generator.families import family_task
from serendipity.testing.strategies import tasks
from tests.verify.packed.test_landmark_cuts import operators
from tests.verify.packed.test_packed_search_equals_brute_force import FAMILY, distances, reached
from verify.base.execution import State, after, applicable
from verify.base.relevance import relevant_part
from verify.base.subproblem import FREE, Subproblem, prices
from verify.exhaustive.team_problem import team_problem
from verify.exhaustive.without_epochs import cheapest_of_team
from verify.packed.affordable import affordable
from verify.packed.operators import FAR, PackedOperator


def paid(task: Task, states: list[State]) -> dict[State, int]:
    """The least weights from the initial state, by relaxing all steps until nothing changes."""
    done = operators(task)
    steps = [
        (state, after(state, action), done[i].weight)
        for state in states
        for i, action in enumerate(task.actions)
        if applicable(action, state)
    ]
    found = {task.init: 0}
    changed = True
    while changed:
        changed = False
        for state, new, weight in steps:
            if state in found and found[state] + weight < found.get(new, FAR):
                found[new], changed = found[state] + weight, True
    return found


def never_left_out(task: Task) -> int:
    """Hold what is left out against all plans; how many operators were left out."""
    states = reached(task)
    before, left = paid(task, states), distances(task, states)
    least, done = left.get(task.init), operators(task)
    facts, out = frozenset(range(len(task.facts))), 0
    for below in (1, 3000) if least is None else (least, least + 1, least + 700, least + 2500):
        kept = affordable(done, facts, task.goal.positive, task.init, below, Deadline())
        if kept is None:
            assert least is None or least >= below
            continue
        for i in set(range(len(done))) - set(kept):
            out += 1
            for state in states:
                if applicable(task.actions[i], state):
                    rest = left.get(after(state, task.actions[i]), int(FAR))
                    assert before[state] + done[i].weight + rest >= below
    return out


@given(tasks())
def test_in_random_tasks(task: Task) -> None:
    never_left_out(task)


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_in_families(name: str, seed: int, size: int) -> None:
    never_left_out(family_task(name, seed, size))


def test_some_are_left_out() -> None:
    assert never_left_out(family_task("logistics", 1, 2)) > 10


def test_a_detour_is_left_out_and_the_way_is_not() -> None:
    """From 0 by 1 to 2, or at a higher price by 3."""
    short = [PackedOperator((0,), (), (1,), (0,), 1), PackedOperator((1,), (), (2,), (1,), 1)]
    long = [PackedOperator((0,), (), (3,), (0,), 2), PackedOperator((3,), (), (2,), (3,), 2)]
    asked = [*short, *long], frozenset(range(4)), (2,), frozenset({0})
    assert affordable(*asked, 5, Deadline()) == [0, 1, 2, 3]
    assert affordable(*asked, 4, Deadline()) == [0, 1]
    assert affordable(*asked, 2, Deadline()) is None


def the_same_optimum(task: Task) -> None:
    """Whole questions: what is left has a plan within the limit just where all has, as cheap a one."""
    options = Options(mode="composite", horizon="inf")
    question = Subproblem(task, options, FREE, (), 0, prices(task, options, ()))
    part = relevant_part(question)
    if part is None:
        return
    whole = cheapest_of_team(question, team_problem(question, part, bounded=False), bounded=False)
    if whole.bound is None:
        return
    for most in (whole.bound - 1, whole.bound, whole.bound + question.prices.scale):
        asked = question.below(most)
        found = cheapest_of_team(asked, team_problem(asked, part, bounded=True), bounded=True)
        assert found.status == ("none" if most < whole.bound else "found")
        assert most < whole.bound or found.bound == whole.bound


@given(tasks())
def test_optima_of_random_tasks(task: Task) -> None:
    the_same_optimum(task)


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_optima_of_families(name: str, seed: int, size: int) -> None:
    the_same_optimum(family_task(name, seed, size))


def test_facts_that_are_as_at_first_are_not_packed() -> None:
    """Where nobody can afford to move a vehicle, its place is no part of a state."""
    task = family_task("logistics", 1, 2)
    options = Options(mode="composite", horizon="inf")
    question = Subproblem(task, options, FREE, (), 0, prices(task, options, ()))
    part = relevant_part(question)
    assert part is not None
    team = team_problem(question, part, bounded=True)
    least = cheapest_of_team(question, team, bounded=False).bound
    assert least is not None
    within = team.below(least + 1, task.init, Deadline())
    assert within is not None
    assert len(within.problem.table.operators) < len(team.problem.table.operators)
    start = within.problem.pack([task.init])
    assert start is not None
    search, found = within.problem.search(start, np.zeros(1, np.int64), least + 1)
    assert found is not None and search.paid(found) == least
