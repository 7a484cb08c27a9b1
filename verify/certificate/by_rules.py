"""What rules alone say of a result: quick, and without loading a solver."""

from collections.abc import Iterable, Iterator

from serendipity.model import Claim, Deadline, Result, Task
from serendipity.model.task.gate import is_bound, needs_time
from verify.base import wording
from verify.base.obligations import complete
from verify.limits import limits
from verify.rules import CLAIMS, check


def check_by_rules(task: Task, result: Result, deadline: Deadline) -> tuple[Claim, ...]:
    """The claims that break a rule, or follow all; what needs an optimiser is not in scope.

    Args:
        result: a result for it, of checked types.
        deadline: what is not checked by then stays undecided.
    """
    return complete(result, _claims(task, result, deadline), by_rules=True)


def _claims(task: Task, result: Result, deadline: Deadline) -> Iterable[Claim]:
    def examine(unit: Task, said: Result) -> tuple[Claim, ...]:
        return tuple(_examined(unit, said, deadline, task))

    if not needs_time(task, options=result.options) and not result.in_time:
        return examine(task, result)
    from verify.calls.single_epochs import examined_in_time

    return examined_in_time(task, result, deadline, examine)


def _examined(task: Task, result: Result, deadline: Deadline, original: Task) -> Iterable[Claim]:
    def alone(own: Task, said: Result) -> Iterable[Claim]:
        if not is_bound(original, said.options):
            return _for_plan(own, said, deadline)
        from verify.rules.nobody_pays import under_the_rule  # where there is such a rule

        def examine(bound: Task, said: Result) -> Iterable[Claim]:
            return _for_plan(bound, said, deadline)

        return under_the_rule(own, said, original, deadline, examine)

    if result.says("goals"):
        from verify.scenarios.check import claims_over_scenarios  # few results have them

        return claims_over_scenarios(task, result, original, deadline, alone)
    if result.mode == "assistance":
        from verify.policy import check_policy

        # a walk through the policy's states, as far as it gets within a moment (semantics 7)
        return check_policy(task, result, deadline.within(limits().rules_seconds), replay_only=True)
    return alone(task, result)


def _for_plan(task: Task, result: Result, deadline: Deadline) -> Iterator[Claim]:
    report = check(task, result, deadline)
    for name in CLAIMS:
        claim = report.claim_of(result, name, wording.FOLLOWED_SO_FAR)
        if claim is not None:
            yield claim
        elif name == "lower_bound" and result.lower_bound is not None:
            yield Claim(name, "not_in_scope", wording.NEEDS_OPTIMISER)
    if result.status == "infeasible":
        yield Claim("infeasible", "not_in_scope", wording.NEEDS_OPTIMISER)
    elif result.status == "optimal":
        best = "optimal" if result.opportunity else "no_opportunity"
        yield Claim(best, "not_in_scope", wording.NEEDS_OPTIMISER)
