"""A call in time, answered in single epochs, and told in time (semantics 10)."""

from dataclasses import replace

from serendipity.model import HumanPlan, Options, Result, Task, UsageError
from serendipity.model.task.horizon import horizon_of
from serendipity.model.task.plans_in_time import times_of
from serendipity.model.task.unit_steps import UnitSteps, unit_steps
from verify.base.beside_script import alone_of
from verify.base.due import after_waiting
from verify.base.optimal_plans import OptimalPlans
from verify.calls.answer import answer
from verify.calls.call import ExaminedCall
from verify.calls.results import to_result
from verify.calls.single_epochs import begun_steps, bystanders_of
from verify.programs.effort import Effort


def solved_in_time(task: Task, options: Options, given: HumanPlan | None, effort: Effort) -> Result:
    """The answer to a call in time.

    Raises:
        PlanError: the human's plan can't be executed after the head start, or misses the goal.
        UsageError: it is about several plans, by the paper's equations, or what the verifier does not know.
    """
    if options.ties != "fixed":
        raise UsageError(f"ties: solved in time for 'fixed' only, not for '{options.ties}'")
    if effort.encoding != "automata":
        raise UsageError("encoding: the paper's equations know no time; expected automata")
    units = unit_steps(task, effort.deadline, options.waiting_cost)
    if given is not None:  # it may come too late, or be in a bystander's way
        late = units.plan(given, options.head_start)
        task.replay_alone(units.begun(late), strict=options.strict)
    plans = OptimalPlans(units.task, alone_of(units.task, effort.deadline, options))
    if given is None or options.mode == "individual":
        start = plans.alone.start
        found = None if start is None else next(plans.plans(start), None)
        epochs, strict = options.head_start, options.strict
        plan = None if found is None else after_waiting(units.task, found, epochs, strict=strict)
    else:
        plan = late
    if plan is not None and options.horizon is not None:
        horizon_of(task, options, units.begun(plan))  # which says whether what it reaches lasts
    call = ExaminedCall(units.task, options, plan, plans, effort)
    return _told(units, plan, to_result(answer(call)))


def _told(units: UnitSteps, plan: HumanPlan | None, said: Result) -> Result:
    """A result in single epochs with the actions of the task itself, each where it begins."""
    task = units.original
    begun = None if plan is None else units.begun(plan)
    times = None if begun is None else times_of(task, begun)
    return replace(
        said,
        human_plan=None if begun is None else tuple(task.actions[i].name for i in begun),
        human_plan_times=None if times is None or times.plain else times,
        plan=None if said.plan is None else begun_steps(task, said.plan, said.options.discount),
        agent_costs={agent: said.agent_costs[agent] for agent in task.agents if said.agent_costs},
        bystanders=bystanders_of(task),
    )
