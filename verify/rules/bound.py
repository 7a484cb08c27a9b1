"""Rules on the lower bound (INTERFACE of results: status, ``lower_bound``)."""

from serendipity.model.numbers import agrees, as_written
from verify.rules.case import CheckedResult, RuleFault


def bound_and_objective(case: CheckedResult) -> RuleFault | None:
    """No lower bound exceeds the objective of a plan."""
    bound, objective = case.result.lower_bound, case.result.objective
    if bound is None or objective is None or as_written(bound) <= as_written(objective):
        return None
    return RuleFault(f"lower_bound {bound:.12g} exceeds the objective {objective:.12g}")


def bound_and_status(case: CheckedResult) -> RuleFault | None:
    """An optimal answer is one whose lower bound meets its objective; ``infeasible`` has none."""
    result = case.result
    bound, objective = result.lower_bound, result.objective
    if result.status == "optimal" and not agrees(bound, None if objective is None else as_written(objective)):
        return RuleFault(f"optimal, but lower_bound is {bound} and the objective {objective}")
    if result.status == "feasible" and result.lower_bound is None:
        return RuleFault("a feasible answer reports a lower bound")
    if result.status == "infeasible" and result.lower_bound is not None:
        return RuleFault("infeasible, but with a lower bound")
    return None
