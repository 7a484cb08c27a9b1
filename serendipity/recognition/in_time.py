"""Observations where actions take time, or beside a script: plans over (state, epoch) that embed them.

How many of them have been matched is part of the state, so their costs are those of two goals (Ramírez and
Geffner 2010): what was seen with all of them matched, and without.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from search import PreparedTask, canonical_human_plan
from search.modes.goals import Likelihood
from serendipity.model import Condition, Deadline, GroundAction, HumanPlan, Options, Task, TimedPlan
from serendipity.model.task.horizon import require_few_epochs
from serendipity.model.task.unit_steps import unit_steps
from serendipity.model.task.variables import Variable


def explained_in_time(
    task: Task,
    goals: Sequence[Condition],
    observed: Sequence[str],
    options: Options,
    deadline: Deadline | None = None,
) -> list[Likelihood]:
    """One explanation for each goal (semantics 8, 10.3), as :class:`search.modes.goals.Explainer` otherwise.

    Args:
        task: the task; its own goal plays no part.
        goals: the candidates.
        observed: names of actions that the human began, in order.
        options: of which interference counts, and what waiting costs.
        deadline: of all of it.

    Raises:
        LimitReachedError: the deadline came.
        UsageError: the task has too many epochs.
    """
    require_few_epochs(task)
    deadline, base = deadline or Deadline(), len(task.facts)
    watched = [*_watched(task, observed)] if observed else [*enumerate(task.actions)]
    counters = tuple(range(base, base + len(observed) + 1))
    counted = replace(
        task,
        facts=(*task.facts, *(f"~seen {count - base}" for count in counters)),
        init=task.init | {base},
        actions=tuple(action for _, action in watched),
        known_variables=(*task.variables, Variable(counters)),
    )
    units = unit_steps(counted if observed else task, deadline, options.waiting_cost)

    def best(goal: Condition) -> tuple[Fraction | None, HumanPlan | None]:
        aimed = PreparedTask(units.task.with_goal(units.goal(goal)))
        found = canonical_human_plan(aimed, deadline, options)
        if found is None:
            return None, None
        cost, plan = units.task.cost_of(found), units.begun(found)
        ids = tuple(watched[i][0] for i in plan)
        return cost, TimedPlan(ids, plan.starts, plan.length) if isinstance(plan, TimedPlan) else ids

    found = []
    for goal in goals:
        if not observed:
            cost, plan = best(goal)
            found.append(Likelihood(cost, None, plan))
            continue
        cost, plan = best(Condition((*goal.positive, counters[-1]), goal.negative))
        other, _ = best(Condition(goal.positive, (*goal.negative, counters[-1])))
        found.append(Likelihood(cost, other, plan))
    return found


def _watched(task: Task, observed: Sequence[str]) -> Iterator[tuple[int, GroundAction]]:
    """The actions with their ids: what was seen as one for each time when it is next, and one for others."""
    base = len(task.facts)
    for number, action in enumerate(task.actions):
        own = action.participants == (task.human,)
        places = [base + k for k, name in enumerate(observed) if own and action.name == name]
        yield number, replace(action, neg=(*action.neg, *places))
        for place in places:
            timing, add, delete = action.timing, action.add, action.delete
            if timing is None:
                add, delete = (*add, place + 1), (*delete, place)
            else:
                begun, gone = (*timing.start_add, place + 1), (*timing.start_delete, place)
                timing = replace(timing, start_add=begun, start_delete=gone)
            yield (
                number,
                replace(action, pre=(*action.pre, place), add=add, delete=delete, timing=timing),
            )
