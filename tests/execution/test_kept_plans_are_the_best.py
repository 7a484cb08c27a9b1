"""What an adviser keeps of a proved plan, while all goes as planned, is as good as planning anew."""

from hypothesis import given, settings
from hypothesis import strategies as st

from search import PreparedTask
from serendipity.execution.adviser import Adviser
from serendipity.execution.guard import Following
from serendipity.execution.world import World
from serendipity.model import Deadline, Options, PlanStep, Task
from serendipity.testing.strategies import corridor_tasks, usar_tasks


def _cost(plan: tuple[PlanStep, ...] | None) -> float:
    return round(sum(step.cost for step in plan or ()), 9)


@settings(max_examples=25)
@given(st.one_of(usar_tasks(), corridor_tasks()), st.sampled_from(["0.5", "0.9"]))
def test_epoch_by_epoch(task: Task, discount: str) -> None:
    options = Options(discount=discount, human_model="observant")  # type: ignore[arg-type]
    keeping, world = Adviser(task, options), World(task, options.discount, strict=False)
    following = Following(PreparedTask(task), strict=False)
    for _ in range(10):
        following.look(world.state, Deadline())
        if following.hopeless or not following.promise():
            break
        names = [task.actions[i].name for i in following.promise()]
        kept = keeping.advise(world.state, names, frozenset(), Deadline())
        fresh = Adviser(task, options).advise(world.state, names, frozenset(), Deadline())
        assert (_cost(kept.plan), kept.status) == (_cost(fresh.plan), fresh.status)
        now = [world.of(step) for step in kept.plan or () if step.epoch == 1]
        world.state = world.after(now)
        his = [i for i in now if task.human in task.actions[i].participants]
        following.acted(his[0] if his and not task.actions[his[0]].joint else None)
