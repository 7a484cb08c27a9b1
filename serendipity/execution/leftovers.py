"""Robots that tidy up: what they leave has to be as it would be without them, but for some facts."""

from collections.abc import Iterable
from glob import escape

from serendipity.facade.kept import with_goals
from serendipity.model import Condition, GroundAction, Options, Task
from serendipity.model.task.leftovers import leftovers


def about_robots(task: Task) -> str:
    """Patterns of the facts that name a robot, which it may leave changed unless somebody says otherwise."""
    names = (escape(task.agents[robot]) for robot in task.robots)
    return ", ".join(f"*[ _]{name}[ _]*, *[ _]{name}, {name}[ _]*" for name in names)


def tidying(task: Task, free: str) -> Task:
    """The task in which that is a goal of the robots' (semantics 12).

    What people may change, what goes on, and what the script changes, is left as these leave it, and what
    goals are about as these ask.

    Args:
        task: where things stand.
        free: patterns of the facts that may be left changed, apart by commas.

    Raises:
        UsageError: these are no patterns.
    """
    rest = leftovers(Options(leave_free=free))
    assert rest is not None, "some facts are free"
    script, robots = task.script, (a for i, a in enumerate(task.actions) if i not in task.of_bystanders)
    anyway = [*(task.actions[i] for i in task.human_actions), *(a for d in script.deeds for a in d.variants)]
    others = _changed(anyway).union((one.fact for one in script.facts), _aims(task))
    kept = sorted(f for f in _changed(robots) - others if rest.price(task.facts[f]) is None)
    true, false = (tuple(f for f in kept if (f in task.init) is wanted) for wanted in (True, False))
    return with_goals(task, Condition(true, false))


def _aims(task: Task) -> set[int]:
    """The facts that goals ask for, with all that can't be true beside them."""
    wanted = {fact for goal in (task.goal, task.robot_goal) for fact in (*goal.positive, *goal.negative)}
    return {fact for one in task.variables if not wanted.isdisjoint(one.facts) for fact in one.facts}


def _changed(actions: Iterable[GroundAction]) -> set[int]:
    """Ids of the facts that some actions may change."""
    return {fact for a in actions for part in a.moments for fact in (*part.add, *part.delete)}
