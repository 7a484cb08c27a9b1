"""Rules on what a result says about its call: mode, human, ``pi_H``, horizon, status."""

from serendipity.model import INFINITE, PlanError
from verify.rules.case import Case, Found
from verify.undecided import UNDECIDED


def mode_and_human(case: Case) -> Found | None:
    """The result belongs to this task's human and to its own options."""
    result, human = case.result, case.task.agents[case.task.human]
    if result.human != human:
        return Found(f"the task's human is {human}, the result's {result.human}")
    if result.mode != result.options.mode:
        return Found(f"the mode is {result.mode}, but {result.options.mode} in the options")
    return None


def human_plan_valid(case: Case) -> Found | None:
    """``pi_H`` is a plan of the human alone; it is missing only if he has none."""
    if isinstance(case.human_plan, PlanError):
        return Found(f"pi_H: {case.human_plan.message}")
    if case.human_plan is not None or case.result.status == "unknown":
        return None
    try:
        optimum = case.alone.optimum(case.task.init)
    except UNDECIDED:
        return None  # left to the integer program
    return None if optimum is None else Found("no pi_H is reported, but the human has a plan alone")


def horizon(case: Case) -> Found | None:
    """``T``: as asked for, else ``|pi_H|``; never shorter (SPEC 2, 3.1)."""
    result = case.result
    asked, said = result.options.horizon, result.horizon
    if result.status == "unknown" or (
        case.human_plan is None and (result.mode == "individual" or result.options.windowed)
    ):
        return None
    expected: int | str | None = asked
    if result.mode == "individual" or (asked is None and case.human_plan is not None):
        expected = len(case.pi_h)
    elif asked is None and result.mode == "composite":
        expected = INFINITE
    if said != expected and expected is not None:
        return Found(f"the horizon is {expected}, the result says {said}")
    if said is None and result.plan is not None:
        return Found("a plan needs a horizon")
    if isinstance(said, int) and said < len(case.pi_h):
        return Found(f"the horizon {said} is shorter than pi_H with its {len(case.pi_h)} actions")
    return None


def status_and_plan(case: Case) -> Found | None:
    """A plan, its cost and objective are there exactly if the status says so."""
    result = case.result
    answered = result.status in ("optimal", "feasible")
    mean = result.options.ties == "expected"
    if answered and result.plan is None and not mean:
        return Found(f"status {result.status} without a plan")
    for name in ("cost", "objective"):
        if answered != (getattr(result, name) is not None):
            return Found(f"status {result.status} {'without' if answered else 'with'} a figure for {name}")
    if not answered and (result.plan is not None or result.window is not None or result.opportunity):
        return Found(f"status {result.status} with a plan, a window or an opportunity")
    return None


def infeasible(case: Case) -> Found | None:
    """``pi_H`` itself is an answer unless the robots have goals (SPEC 3.1, 3.5)."""
    result = case.result
    if result.status == "infeasible" and case.human_plan is not None and not case.robots_goal:
        return Found("infeasible, though doing nothing is an answer: pi_H")
    if result.reason == "no-human-plan" and case.human_plan is not None:
        return Found("the reason is no-human-plan, but pi_H is reported")
    if (
        result.status == "optimal"
        and result.mode in ("individual", "serendipity")
        and case.human_plan is None
    ):
        return Found(f"an answer in mode {result.mode} without pi_H")
    return None
