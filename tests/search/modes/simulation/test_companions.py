"""A companion's plans: the best that leave the person's plan alone; what was found before is not lost."""

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from search import PreparedTask, optimal_human_plans
from search.modes.simulation.companion import Companion
from search.modes.simulation.human import Start
from serendipity.model import Deadline, Options, Task
from serendipity_testing.builders import usar
from serendipity_testing.strategies import tasks, usar_tasks

NOTHING = frozenset[int]()


def _companion(task: Task) -> Companion:
    options = Options(discount="0.9", human_model="observant")  # type: ignore[arg-type]
    return Companion(PreparedTask(task), options, Deadline())


def _start(companion: Companion, task: Task) -> Start | None:
    plans = optimal_human_plans(PreparedTask(task), Deadline())
    init = companion.human.packed.init
    return None if plans is None else Start(init, init, companion.human.intends(plans.canonical()))


def _in_a_corridor() -> tuple[Task, Companion, Start]:
    ways, robots, kits = "a0-a1-a2-a3-c-d-g d-s c-r-r2", {"r": "r", "q": "g"}, {"k1": "s", "k2": "r2"}
    task = usar(ways, human="a0", robots=robots, kits=kits, triage="g")
    companion = _companion(task)
    start = _start(companion, task)
    assert start is not None
    return task, companion, start


def test_what_was_found_before_is_not_lost_when_there_is_no_time() -> None:
    _, companion, start = _in_a_corridor()
    found = companion.course(start, [NOTHING], Deadline())
    assert found is not None and found.proved and found.cost == Fraction("8.4") and found.alone == 10
    kept = companion.course(start, [], Deadline(), known=found.steps)
    assert kept is not None and (kept.cost, kept.steps, kept.proved) == (found.cost, found.steps, False)
    idle = companion.course(start, [], Deadline())
    assert idle is not None and idle.cost == 10 and not idle.pays


def test_what_may_not_begin_does_not() -> None:
    task, companion, start = _in_a_corridor()
    own = set(task.human_actions)
    found = companion.course(start, [NOTHING], Deadline(), begins=lambda actions: own.issuperset(actions))
    assert found is not None and not any(s.epoch == 1 and s.action not in own for s in found.steps)


@given(st.one_of(tasks(), usar_tasks()))
def test_the_plan_that_is_being_followed_works_unless_it_is_dropped_for_a_cheaper_one(task: Task) -> None:
    if task.robot_goal:
        return
    companion = _companion(task)
    start = _start(companion, task)
    found = None if start is None else companion.course(start, [NOTHING], Deadline())
    if found is None or start is None:
        return
    played = companion.played(start, found.steps, Deadline())
    assert played.goals_hold and played.cost == found.cost
    for before, epoch in zip(played.epochs, played.epochs[1:], strict=False):
        if before.accepted is None and epoch.kept is None and epoch.best is not None:
            left = task.cost_of(before.plan[1:])
            assert epoch.best < left
