"""The search for a better policy finds what brute force finds, whatever the policy and the risk."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from serendipity.model import Condition, HumanPlan, Options, Task
from serendipity.testing.oracle import optimal_human_plan
from serendipity.testing.oracle.scenarios import PolicyOptimum, PossibleGoal, best_policy
from tests.search.modes.goals.strategies import reachable_goals, rivals
from tests.testing.oracle.test_scenarios_by_hand import Scenario
from verify.base.optimal_plans import OptimalPlans
from verify.base.undecided import UndecidedError
from verify.calls.call import ExaminedCall
from verify.programs.effort import Effort
from verify.proofs.book import ProofWriter
from verify.scenarios.measure import Measure
from verify.scenarios.policies import Better, PolicySearch
from verify.scenarios.program import refute_policies
from verify.scenarios.proof import floor_of

_OPTIONS = st.builds(
    Options,
    discount=st.sampled_from(["0", "0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["1000", "0", "0.25", "1"]),
    interference=st.sampled_from(["paper", "strict"]),
    suffix=st.sampled_from(["replan", "replan", "subplan"]),
    preservation=st.sampled_from(["kernel", "kernel", "state"]),
    max_window=st.sampled_from([None, None, 1, 2]),
    policy=st.sampled_from(["watching", "watching", "fixed"]),
    risk=st.sampled_from(["mean", "worst", "regret"]),
)
_LONGEST = 4
_FAR = 10**100


@st.composite
def _scenarios(draw: st.DrawFn) -> tuple[Task, list[PossibleGoal]]:
    """Two or three goals, the human's plan for each."""
    task, candidates = draw(rivals())
    found: list[PossibleGoal] = [Scenario(c.goal, c.plan, c.weight) for c in candidates]
    if draw(st.booleans()):
        goal = draw(reachable_goals(task))
        plan = optimal_human_plan(replace(task, goal=goal))
        assert plan is not None
        third = Scenario(goal, plan, Fraction(1, 2))
        found = [third, *(Scenario(c.goal, c.plan, c.weight / 2) for c in found)]
    return task, found


@pytest.mark.long
@given(_scenarios(), _OPTIONS, st.integers(0, 1))
@settings(max_examples=60)
def test_the_least_value_is_that_of_brute_force(
    given_scenarios: tuple[Task, list[PossibleGoal]], options: Options, later: int
) -> None:
    task, scenarios = given_scenarios
    horizon = max(len(scenario.plan) for scenario in scenarios) + later
    if not 0 < horizon <= _LONGEST:
        return
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
        return PolicySearch(calls, measure).better(than)

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
