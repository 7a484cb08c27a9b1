"""The search for a better policy in time finds what brute force finds, whatever the policy and the risk."""

from hypothesis import given, settings

from serendipity.model import Options, Task
from serendipity.model.task.unit_steps import unit_steps
from serendipity.testing.oracle.scenarios import best_policy
from tests.testing.oracle.test_scenarios_by_hand import Scenario
from tests.verify.time.scenarios import scenarios_in_time
from verify.base.beside_script import alone_of
from verify.base.optimal_plans import OptimalPlans
from verify.calls.call import ExaminedCall
from verify.scenarios.measure import Measure
from verify.scenarios.policies import Better, PolicySearch
from verify.scenarios.proof import floor_of

_FAR = 10**100


@given(scenarios_in_time())
@settings(max_examples=60)
def test_the_least_value_is_that_of_brute_force(drawn: tuple[Task, list[Scenario], Options]) -> None:
    task, scenarios, options = drawn
    right = best_policy(task, options, scenarios, int(options.horizon or 0))
    calls = [_call(task, options, scenario) for scenario in scenarios]
    measure = Measure(calls, [scenario.weight for scenario in scenarios], [floor_of(call) for call in calls])

    def better(than: int) -> Better | None:
        return PolicySearch(calls, measure).better(than)

    found = better(_FAR)
    assert found is not None
    assert measure.figures(found.value) == right.least
    assert better(found.value) is None
    assert measure.joined(measure.floors) <= found.value


def _call(task: Task, options: Options, scenario: Scenario) -> ExaminedCall:
    units = unit_steps(task.with_goal(scenario.goal))
    plans = OptimalPlans(units.task, alone_of(units.task, options=options))
    return ExaminedCall(units.task, options, units.plan(scenario.plan), plans)
