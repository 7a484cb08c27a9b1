"""What robots expect a person to do next is what they do, whatever was changed behind their back."""

from hypothesis import given
from hypothesis import strategies as st

from serendipity.execution import Execution, Replanner, moment_of
from serendipity.model import Task
from serendipity.testing.strategies import tasks, usar_tasks


def _in_step(task: Task, human_model: str, discount: str) -> None:
    run, person = Execution(task, discount=discount, human_model=human_model), Replanner(task, human_model)
    while not run.done and run.epoch < 40:
        plan, expected = run.decided.plan, run.decided.expected
        passed = run.step(person.choose(moment_of(run)))
        if plan is not None:
            assert passed.human == (None if expected is None else expected.action)


@given(
    st.one_of(tasks(), usar_tasks()), st.sampled_from(["observant", "local"]), st.sampled_from(["0.5", "0.9"])
)
def test_in_each_epoch(task: Task, human_model: str, discount: str) -> None:
    _in_step(task, human_model, discount)
