"""Calls that may be refused: judges that agree to refuse any other are both wrong."""

from itertools import islice

from serendipity.facade.call import options_from
from serendipity.model import INFINITE, Options, PlanError, UsageError
from serendipity.testing.generator.calls import PlanCall
from verify.base.optimal_plans import OptimalPlans


def may_be_refused(call: PlanCall) -> bool:
    """True if an option has no legal value, a plan does not work, or a horizon is missing or too short."""
    try:
        options = options_from(call.keywords())
        given = None if call.human_plan is None else call.task.plan_from_names(call.human_plan)
    except (UsageError, PlanError):
        return True
    plans = OptimalPlans(call.task)
    plan = plans.canonical() if given is None else given
    tied = options.ties != "fixed" and given is None
    if tied and len(list(islice(plans.plans(), options.max_ties + 1))) > options.max_ties:
        return True
    return _lacks_horizon(call, options, None if plan is None else len(plan))


def _lacks_horizon(call: PlanCall, options: Options, length: int | None) -> bool:
    """Semantics 2, 3.5; ``length`` is that of ``pi_H``, None where there is none."""
    if options.horizon is not None:
        return options.horizon != INFINITE and length is not None and int(options.horizon) < length
    if length is None:
        return options.mode == "communication"
    return length == 0 and not call.task.robot_goal.holds(call.task.init)
