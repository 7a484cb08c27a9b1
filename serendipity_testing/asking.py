"""Calls as values with ids, and calls with nothing left open."""

from dataclasses import fields, replace
from typing import Final

from serendipity.facade.call import options_from
from serendipity.model import Options
from serendipity_testing.call import Call
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.oracle import optimal_human_plan
from serendipity_testing.oracle.plans import Plans

_DEFAULT: Final = Options()


def call_of(call: PlanCall) -> Call:
    """A call that was written as text.

    Raises:
        UsageError: an option has no legal value.
        PlanError: the plan that is given is none.
    """
    options, plan = options_from(call.keywords()), None
    if call.human_plan is not None:
        plan = call.task.plan_from_names(call.human_plan, options.head_start)
    return Call(call.task, options, plan)


def written(call: Call) -> PlanCall:
    """A call as text: the options that are not the default."""
    options: dict[str, str] = {"mode": call.options.mode}
    for field in fields(Options):
        value = getattr(call.options, field.name)
        if value != getattr(_DEFAULT, field.name):
            options[field.name] = str(value).lower() if isinstance(value, bool) else str(value)
    names = call.human_plan_names
    return PlanCall(call.task, options, None if names is None else tuple(names))


def settled(call: Call) -> Call:
    """The call with ``pi_H`` (the canonical one, by brute force, where none is given) and ``T``.

    Where the human has no plan alone there is none; in mode ``individual``, and where no window could
    open, there is no horizon.

    Raises:
        UsageError: the horizon is missing, or too short.
    """
    plan = optimal_human_plan(call.task) if call.human_plan is None else call.human_plan
    horizon = Plans(call.task, call.options, plan).horizon
    return replace(call, options=call.options.but(horizon=horizon), human_plan=plan)
