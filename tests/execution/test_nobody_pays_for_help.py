"""Whatever robots do: a person who replans on sight reaches the goal and never pays more than alone."""

from itertools import count
from random import Random

from hypothesis import given
from hypothesis import strategies as st

from serendipity.execution import Execution
from serendipity.execution.persons import Replanner, moment_of
from serendipity.model import Task
from tests.support.strategies import tasks
from verify.base.optimal_plans import OptimalPlans
from verify.simulator.person import Person

MOST_EPOCHS = 60


def _lived_through(task: Task, run: Execution, person: Replanner) -> None:
    alone = Person(task, OptimalPlans(task))
    least = alone.cost(task.init)
    if least is None:
        return
    for epoch in count(1):
        if run.done:
            break
        assert epoch < MOST_EPOCHS, "the person never gets there"
        run.step(person.choose(moment_of(run)))
        kept, best = alone.cost_of(person.plan, run.state), alone.cost(run.state)
        assert best is not None, "robots took the person's last plan away"
        followed = not any(len(step.agents) > 1 for step in run.passed[-1].steps)
        assert kept is not None or not followed, "robots spoilt the plan that the person was following"
        assert run.human_cost + best <= least
    assert run.human_cost <= least


@given(tasks(), st.sampled_from(["0", "0.5", "0.9", "1"]))
def test_with_the_plan_that_robots_expect(task: Task, discount: str) -> None:
    _lived_through(task, Execution(task, discount=discount), Replanner(task))


@given(tasks(), st.sampled_from(["0.5", "0.9"]), st.integers(0, 2**32))
def test_with_any_of_their_optimal_plans(task: Task, discount: str, seed: int) -> None:
    _lived_through(task, Execution(task, discount=discount), Replanner(task, dice=Random(seed)))
