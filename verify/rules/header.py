"""Rules on what a result says about its call: task, mode, human, ``pi_H``, horizon, status."""

from serendipity.model import INFINITE, InputError, PlanError, Result, Task
from verify.base.obligations import is_mean
from verify.rules.case import CheckedResult, RuleFault


def require_same_task(task: Task, result: Result) -> None:
    """Return if a result may be about a task.

    Raises:
        InputError: its human, or an action of its ``pi_H``, is not of the task.
    """
    human = task.agents[task.human]
    if result.human != human:
        raise InputError(f"result: is for another task: its human is '{result.human}', not '{human}'")
    stranger = next((name for name in result.human_plan or () if name not in task.named), None)
    if stranger is not None:
        raise InputError(
            f"result: is for another task: this one has no action '{stranger}' of its human plan"
        )


def mode_and_human(case: CheckedResult) -> RuleFault | None:
    """The result belongs to this task's human and to its own options."""
    result, human = case.result, case.task.agents[case.task.human]
    if result.human != human:
        return RuleFault(f"the task's human is {human}, the result's {result.human}")
    if result.mode != result.options.mode:
        return RuleFault(f"the mode is {result.mode}, but {result.options.mode} in the options")
    if result.policy is not None:
        return RuleFault(f"a policy, which mode {result.mode} does not have")
    return None


def human_plan_valid(case: CheckedResult) -> RuleFault | None:
    """``pi_H`` is a plan of the human alone; it is missing only if they have none, or nothing rests on it."""
    if isinstance(case.human_plan, PlanError):
        return RuleFault(f"pi_H: {case.human_plan.message}")
    if case.human_plan is not None or _unknown_to_search(case):
        return None
    optimum = case.alone.predicted()
    return None if optimum is None else RuleFault("no pi_H is reported, but the human has a plan alone")


def _unknown_to_search(case: CheckedResult) -> bool:
    """Whether ``pi_H`` may be missing since a limit came before it was known: nothing rests on it."""
    result, options = case.result, case.result.options
    if result.status == "unknown":
        return result.lower_bound is None or result.mode == "composite"
    endless = result.mode == "composite" and options.horizon == INFINITE
    return endless and options.max_cost is None and not case.robots_goal


def horizon(case: CheckedResult) -> RuleFault | None:
    """``T``: as asked for, else ``|pi_H|``; never shorter, nor than the human's own answer (semantics 2)."""
    result = case.result
    asked, said = result.options.horizon, result.horizon
    if result.status == "unknown" and said is None:
        return None
    if case.human_plan is None and (result.mode == "individual" or result.options.windowed):
        return None if said is None else RuleFault("a horizon, though there is no pi_H")
    expected: int | str | None = asked
    if result.mode == "individual":
        expected = max([len(case.pi_h), *(step.epoch for step in result.plan or ())])
    elif asked is None and case.human_plan is not None:
        expected = len(case.pi_h)
    elif asked is None and result.mode == "composite":
        expected = INFINITE
    if said != expected and expected is not None:
        return RuleFault(f"the horizon is {expected}, the result says {said}")
    if said is None and result.plan is not None:
        return RuleFault("a plan needs a horizon")
    if isinstance(said, int) and said < len(case.pi_h):
        return RuleFault(f"the horizon {said} is shorter than pi_H with its {len(case.pi_h)} actions")
    return None


def status_and_fields(case: CheckedResult) -> RuleFault | None:
    """A plan and what belongs to one are there exactly if the status says so."""
    result = case.result
    answered = result.status in ("optimal", "feasible")
    if answered and result.plan is None and not is_mean(result):
        return RuleFault(f"status {result.status} without a plan")
    for name in ("cost", "objective"):
        if answered != (getattr(result, name) is not None):
            return RuleFault(
                f"status {result.status} {'without' if answered else 'with'} a figure for {name}"
            )
    compared = answered and result.human_plan is not None
    for name in ("saving", "saving_alone"):
        there = getattr(result, name) is not None
        if not there and name == "saving_alone" and result.status == "feasible":
            continue  # the limit came before that was known
        if there != compared and not (compared and case.robots_goal):  # where the baseline decides
            return RuleFault(
                f"{name} is {'there' if there else 'missing'}: it goes with an answer and a pi_H"
            )
    if result.window is not None and result.options.human_model != "omniscient":
        return RuleFault("a window, to which a human who replans is not bound")
    if result.plan is None and (result.window is not None or result.agent_costs or result.realised):
        return RuleFault("a window, costs of agents or verdicts on humans, but no plan")
    if not answered and (result.plan is not None or result.opportunity):
        return RuleFault(f"status {result.status} with a plan or an opportunity")
    return None


def reason(case: CheckedResult) -> RuleFault | None:
    """An answer without a plan gives the reason; an answer with a plan gives none."""
    result = case.result
    if result.status in ("optimal", "feasible"):
        return None if result.reason is None else RuleFault(f"status {result.status} with a reason")
    expected = infeasible_because(result)
    if result.status == "infeasible" and result.reason != expected:
        return RuleFault(f"the reason is {expected}, the result says {result.reason!r:.50}")
    return None


def infeasible_because(result: Result) -> str:
    """Why there is no plan (``Result.reason``): of what kind the answer's proof is."""
    needs_pi_h = result.mode == "individual" or result.options.windowed
    if result.human_plan is None and needs_pi_h:
        return "no-human-plan"
    return "no-plan" if result.horizon == INFINITE else "no-plan-within-horizon"


def infeasible(case: CheckedResult) -> RuleFault | None:
    """``pi_H`` itself is an answer unless the robots have goals (semantics 3.1, 3.5)."""
    result = case.result
    if result.status == "infeasible" and case.human_plan is not None and not case.robots_goal:
        return RuleFault("infeasible, though doing nothing is an answer: pi_H")
    answered = result.status in ("optimal", "feasible")
    if answered and result.mode in ("individual", "serendipity") and case.human_plan is None:
        return RuleFault(f"an answer in mode {result.mode} without pi_H")
    return None
