"""Whether a claim can be so in any mode: by the verifier's rules, and by the least objective."""

from collections import defaultdict
from dataclasses import replace
from typing import Final

from serendipity.facade.certify import check
from serendipity.model import Result
from serendipity_testing.asking import call_of, settled
from serendipity_testing.by_hand import result as result_of
from serendipity_testing.call import Answered, Call
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.judges.claims import Proposal, fault_of_joint

_HELD: Final = ("replay", "window")
"""Claims of a certificate that are about the plan itself; figures are worked out from it here."""


def fault(call: PlanCall, claim: Proposal, proved: Answered | None) -> str | None:
    """The fault in a claim, or None.

    Args:
        proved: a proved answer of another method, or None.

    Raises:
        UsageError: the call can't be asked.
    """
    if claim.epochs is None or claim.plan is None:
        return fault_of_joint(call, claim, proved)
    asked = settled(call_of(call))
    answer = as_result(asked, claim)
    for found in check(call.task, answer).claims:
        if found.claim in _HELD and found.verdict == "refuted":
            return f"its plan breaks a rule: {found.reason}"
    if proved is None:
        return None
    if proved.status == "infeasible":
        return "its plan is one, where none was said to be"
    return _not_the_least(asked, claim, answer, proved)


def as_result(call: Call, claim: Proposal) -> Result:
    """A claim with a plan as a result, its figures worked out from the plan."""
    plan: dict[int, list[str]] = defaultdict(list)
    for epoch, i in zip(claim.epochs or (), claim.plan or (), strict=True):
        plan[epoch].append(call.task.actions[i].name)
    options = {
        name: value for name, value in call.options.to_dict().items() if name not in ("horizon", "max_cost")
    }
    names = call.human_plan_names
    answer = result_of(
        call.task,
        {epoch: "; ".join(actions) for epoch, actions in sorted(plan.items())},
        human_plan=None if names is None else tuple(names),
        window=claim.window,
        horizon=call.options.horizon,
        max_cost=call.options.max_cost,
        **options,
    )
    return replace(answer, opportunity=claim.window is not None) if call.options.windowed else answer


def _not_the_least(call: Call, claim: Proposal, answer: Result, proved: Answered) -> str | None:
    least, cost = float(proved.objective or 0), float(answer.objective or 0)
    if call.options.windowed and (claim.window is not None) != proved.opportunity:
        if proved.opportunity:
            return f"it leaves the human alone, where help makes the objective {least:g}"
        return f"it helps at cost {answer.cost:g}, where leaving the human alone is best"
    if cost < least or (claim.status == "optimal" and cost > least):
        return f"its objective is {cost:g}, where {least:g} is the least"
    return None
