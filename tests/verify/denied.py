"""Help that is denied: doctored answers that tests of several rooms ask about."""

from dataclasses import replace

from serendipity.model import PlanStep, Result, Task
from serendipity.model.numbers import figure


def denied(task: Task, right: Result) -> Result:
    """The same call, answered that nothing helps: ``pi_H``, its cost, and a bound that meets it."""
    names, times, cost = right.human_plan or (), right.human_plan_times, right.human_cost
    ids = task.plan_from_names(right.human_entries or ())
    starts = task.starts_of(ids) if times is None else times.starts
    human = task.agents[task.human]
    steps = tuple(
        PlanStep(start, (human,), name, figure(task.actions[i].cost), task.actions[i].duration)
        for start, name, i in zip(starts, names, ids, strict=True)
    )
    assert cost is not None
    figures = {"cost": cost, "objective": cost, "lower_bound": cost, "saving": 0.0}
    shares = {**dict.fromkeys(task.agents, 0.0), human: cost}
    realised = dict.fromkeys(right.realised, True)
    idle = replace(right, opportunity=False, window=None, plan=steps, agent_costs=shares, realised=realised)
    return replace(idle, **figures)
