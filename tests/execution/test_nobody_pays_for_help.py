"""Whatever robots do: a person who replans on sight reaches the goal and never pays more than alone.

And robots know what that person does next.
"""

from random import Random

from hypothesis import given
from hypothesis import strategies as st

from serendipity.execution import Execution, Replanner, moment_of
from serendipity.model import Task
from serendipity.robot import Simulated
from serendipity_testing.strategies import tasks, usar_tasks
from tests.execution.living import live, other_goals

DISCOUNTS = st.sampled_from(["0", "0.5", "0.9", "1"])
SEEDS = st.integers(0, 2**32)


@given(tasks(), DISCOUNTS)
def test_who_follows_the_plan_that_robots_expect(task: Task, discount: str) -> None:
    live(task, Execution(task, discount=discount), Replanner(task))


@given(tasks(), DISCOUNTS, SEEDS)
def test_who_follows_any_of_their_optimal_plans(task: Task, discount: str, seed: int) -> None:
    run, person = Execution(task, discount=discount), Replanner(task, dice=Random(seed))
    live(task, run, person, predicted=False)


@given(tasks(), DISCOUNTS)
def test_who_sees_only_what_is_where_they_are(task: Task, discount: str) -> None:
    run, person = Execution(task, discount=discount, human_model="local"), Replanner(task, "local")
    live(task, run, person, sees_all=False)


@given(usar_tasks(), DISCOUNTS)
def test_who_is_taken_to_be_omniscient_and_is_not(task: Task, discount: str) -> None:
    live(task, Execution(task, discount=discount, human_model="omniscient"), Replanner(task))


@given(tasks(), DISCOUNTS, SEEDS)
def test_whose_robots_fail_and_drop_out(task: Task, discount: str, seed: int) -> None:
    robots = Simulated(Random(seed), fail=0.2, slow=0.3)
    run = Execution(task, discount=discount, adapter=robots)
    live(task, run, Replanner(task))


@given(tasks(), SEEDS)
def test_whose_goal_robots_do_not_know(task: Task, seed: int) -> None:
    goals = other_goals(task, Random(seed))
    live(task, Execution(task, discount="0.9", goals=goals), Replanner(task))


@given(
    st.one_of(tasks(), usar_tasks()), st.sampled_from(["observant", "local"]), st.sampled_from(["0.5", "0.9"])
)
def test_who_is_expected_to_do_what_they_do(task: Task, human_model: str, discount: str) -> None:
    """Whatever was changed behind their back."""
    run, person = Execution(task, discount=discount, human_model=human_model), Replanner(task, human_model)
    while not run.done and run.epoch < 40:
        plan, expected = run.decided.plan, run.decided.expected
        passed = run.step(person.choose(moment_of(run)))
        if plan is not None:
            assert passed.human == (None if expected is None else expected.action)
