"""What an adviser keeps of a proved plan, while all goes as planned, is as good as planning anew."""

from hypothesis import given, settings
from hypothesis import strategies as st

from serendipity.execution.advice import DecisionPoint
from serendipity.execution.guard import RobotActions
from serendipity.execution.hypotheses import Hypothesis
from serendipity.execution.world import World
from serendipity.model import Deadline, Options, Task
from serendipity_testing.strategies import corridor_tasks, usar_tasks


@settings(max_examples=25)
@given(
    st.one_of(usar_tasks(), corridor_tasks()),
    st.sampled_from(["0.5", "0.9"]),
    st.sampled_from(["observant", "omniscient"]),
)
def test_epoch_by_epoch(task: Task, discount: str, human_model: str) -> None:
    options = Options(discount=discount, human_model=human_model)  # type: ignore[arg-type]
    actions, world = RobotActions(task), World(task, options.discount, strict=False)
    keeping = Hypothesis(task, options, actions, task.init, Deadline(), told=True)
    for _ in range(10):
        keeping.following.look(world.state)
        if keeping.following.hopeless or not keeping.following.promise():
            break
        now = DecisionPoint(world.state, frozenset(), frozenset(), frozenset(), lambda _: True)
        kept = keeping.adviser.advise(keeping.following, now, Deadline())
        other = Hypothesis(task, options, actions, task.init, Deadline(), told=True)
        fresh = other.adviser.advise(keeping.following, now, Deadline())
        if kept is None or fresh is None:  # robots' own goals are out of reach
            assert kept is fresh and task.robot_goal
            break
        assert (kept.cost, kept.proved) == (fresh.cost, fresh.proved)
        done = [world.of(step) for step in kept.plan if step.epoch == 1]
        world.state = world.after(done)
        his = [i for i in done if task.human in task.actions[i].participants]
        own = his[0] if his and not task.actions[his[0]].joint else None
        keeping.following.acted(own, done)
