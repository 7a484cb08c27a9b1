"""The search for a better policy finds what brute force finds, whatever the policy and the risk."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given, settings

from serendipity.model import Condition, HumanPlan, Options, Task
from serendipity_testing.builders import task as build
from serendipity_testing.oracle.scenarios import PolicyOptimum, best_policy
from tests.verify.scenarios.three_ways import Asked, calls_over_scenarios, is_small
from verify.base.optimal_plans import OptimalPlans
from verify.base.undecided import UndecidedError
from verify.calls.call import ExaminedCall
from verify.programs.effort import Effort
from verify.proofs.book import ProofWriter
from verify.scenarios.measure import Measure
from verify.scenarios.policies import Better, PolicyEnumeration
from verify.scenarios.program import refute_policies
from verify.scenarios.proof import floor_of

_FAR = 10**100


def test_brute_force_is_not_asked_about_no_scenarios() -> None:
    """It failed where none of the goals can be reached."""
    assert not is_small((build(init="a", goal="a", actions={}), [], Options()))


@pytest.mark.long
@given(calls_over_scenarios())
@settings(max_examples=100)
def test_the_least_value_is_that_of_brute_force(asked: Asked) -> None:
    if not is_small(asked):
        return
    task, scenarios, options = asked
    horizon = int(options.horizon or max(len(scenario.plan) for scenario in scenarios))
    right = best_policy(task, options, scenarios, horizon)
    calls = [_call(task, options.but(horizon=horizon), s.goal, s.plan) for s in scenarios]
    require_least(calls, [scenario.weight for scenario in scenarios], right)


def require_least(calls: list[ExaminedCall], weights: list[Fraction], right: PolicyOptimum) -> None:
    """Fail where the search finds another least value than brute force, or none just above it.

    Nor may what a proof says of all policies refute that one.
    """
    floors = [floor_of(call) for call in calls]
    measure, plain = Measure(calls, weights, floors), Measure(calls, weights, floors, plain=True)
    effort = Effort(method="program", proof=ProofWriter())
    asked = [replace(call, effort=effort) for call in calls if call.horizon]
    if asked:
        with pytest.raises(UndecidedError):
            refute_policies(asked, plain, plain.number(right.least) + 1)

    def better(than: int) -> Better | None:
        return PolicyEnumeration(calls, measure).better(than)

    found = better(_FAR)
    assert found is not None
    assert measure.figures(found[0]) == right.least
    assert better(found[0]) is None
    tight = better(found[0] + 1)
    assert tight is not None and tight[0] == found[0]
    assert measure.joined(measure.floors) <= found[0]


def _call(task: Task, options: Options, goal: Condition, plan: HumanPlan) -> ExaminedCall:
    own = replace(task, goal=goal)
    return ExaminedCall(own, options, plan, OptimalPlans(own))
