"""Numbers of operators weigh no more than plans do, their landmarks are on every plan, and they say much."""

import pytest
from hypothesis import given

from serendipity.model import Deadline, Task
from serendipity.testing.generator.families import family_task
from serendipity.testing.strategies import tasks
from tests.verify.packed.test_packed_search_equals_brute_force import FAMILY, distances, reached, team_problem
from verify.packed.pattern import FAR
from verify.programs.counts import MissedLandmarks, least_weight
from verify.programs.effort import Effort

_MOST = 10**6


def sound(task: Task) -> None:
    """From the first state and the last no bound is above the distance."""
    states = reached(task)
    expected = distances(task, states)
    table = team_problem(task).table
    for state in states[:: max(1, len(states) - 1)]:
        least = expected.get(state, FAR)
        bound = least_weight(table, state, task.goal.positive, min(least + 1, _MOST), Effort())
        assert bound.least <= least


@given(tasks())
def test_no_bound_exceeds_a_plan_in_random_tasks(task: Task) -> None:
    sound(task)


@pytest.mark.parametrize(("name", "seed", "size"), FAMILY)
def test_no_bound_exceeds_a_plan_in_families(name: str, seed: int, size: int) -> None:
    sound(family_task(name, seed, size))


def test_they_say_more_than_half() -> None:
    """Carrying parcels is nearly all there is to count."""
    task = family_task("logistics", 1, 2)
    least = distances(task, reached(task))[task.init]
    bound = least_weight(team_problem(task).table, task.init, task.goal.positive, least, Effort())
    assert bound.least > 0.9 * least
    assert bound.landmarks > 0


@given(tasks())
def test_a_landmark_is_on_every_plan(task: Task) -> None:
    """Without its operators the goal is not reached."""
    problem = team_problem(task)
    kept = problem.table.operators
    landmarks = MissedLandmarks(problem.table, task.init, task.goal.positive, Deadline())
    for landmark in landmarks.missed([0] * len(kept)):
        without = [each for k, each in enumerate(kept) if k not in landmark]
        seen, queue = {task.init}, [task.init]
        for state in queue:
            assert not state.issuperset(task.goal.positive)
            for each in without:
                if state.issuperset(each.pre) and state.isdisjoint(each.neg):
                    new = state.difference(each.delete).union(each.add)
                    if new not in seen:
                        seen.add(new)
                        queue.append(new)
