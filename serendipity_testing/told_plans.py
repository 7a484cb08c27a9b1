"""A plan that is wrong beside one that is better, in words."""

from collections.abc import Iterable

from serendipity.facade.planning import plan
from serendipity.model import Options, Result
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.judges.claims import Proposal, cost_of


def both_plans(
    call: PlanCall, claim: Proposal, options: Options, human_plan: Iterable[str] | None
) -> dict[str, str]:
    """The plan of a claim, and ours; the first only where there is one."""
    ours = plan(call.task, human_plan=human_plan, **options.to_dict())
    return claimed_plan(call, claim, "its") | told_plan(ours)


def claimed_plan(call: PlanCall, claim: Proposal, whose: str) -> dict[str, str]:
    """The plan of a claim, where there is one."""
    if claim.plan is None:
        return {}
    epochs = claim.epochs or range(1, len(claim.plan) + 1)
    steps = [(epoch, call.task.actions[i].name) for epoch, i in zip(epochs, claim.plan, strict=True)]
    return {f"{whose} plan, cost {float(cost_of(call, claim.plan)):g}": _told(steps)}


def told_plan(ours: Result) -> dict[str, str]:
    """Our plan, where there is one."""
    if ours.plan is None or ours.cost is None:
        return {}
    return {f"our plan, cost {ours.cost:g}": _told([(step.epoch, step.action) for step in ours.plan])}


def _told(steps: Iterable[tuple[int, str]]) -> str:
    return "; ".join(f"{epoch}: {action}" for epoch, action in steps) or "nothing"
