"""Robots that tidy up: what they leave has to be as it would be without them, but for some facts."""

from serendipity.facade.kept import kept, with_goals
from serendipity.facade.planning import plan
from serendipity.model import Condition, Options, Task, UsageError


def tidying(task: Task, free: str) -> Task:
    """The task in which that is a goal of the robots' (semantics 12).

    What the person may change themselves is theirs, and nobody puts it back.

    Args:
        task: where things stand.
        free: patterns of the facts that may be left changed, apart by commas.

    Raises:
        UsageError: the person has no plan alone, or these are no patterns.
    """
    options = Options(leave_free=free, nobody_pays=False)
    names = plan(task, mode="individual").human_plan
    if names is None:
        raise UsageError("leave_free: the person has no plan alone, so it is not known what they would leave")
    theirs = task.plan_from_names(names)
    rule = kept(task, options, theirs, task.epochs_of(theirs), task)
    own = (task.actions[i] for i in task.human_actions)
    changed = {fact for action in own for fact in (*action.add, *action.delete)}
    return with_goals(task, rule.facts.without(Condition(tuple(changed), tuple(changed))))
