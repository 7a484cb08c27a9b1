"""Small tasks in time, and what the human may be about to do in them."""

from fractions import Fraction

from hypothesis import assume
from hypothesis import strategies as st

from serendipity.model import Condition, Options, Task
from serendipity.model.task.plans_in_time import outlasts
from serendipity.testing.oracle.alone_in_time import plans_in_time
from serendipity.testing.strategies.time import tasks_in_time, timed_plans
from tests.search.modes.goals.strategies import reachable_goals
from tests.testing.oracle.test_scenarios_by_hand import Scenario

LONGEST = 5

OPTIONS = st.builds(
    Options,
    discount=st.sampled_from(["0", "0.5", "0.9", "1"]),
    window_weight=st.sampled_from(["1000", "0", "0.25", "1"]),
    interference=st.sampled_from(["paper", "strict"]),
    max_window=st.sampled_from([None, None, 1, 2]),
    policy=st.sampled_from(["watching", "watching", "fixed"]),
    risk=st.sampled_from(["mean", "worst", "regret"]),
)


@st.composite
def scenarios_in_time(draw: st.DrawFn) -> tuple[Task, list[Scenario], Options]:
    """Two or three plans that are optimal but for some waiting, and a horizon that all last until."""
    drawn = draw(tasks_in_time())
    task = drawn.with_goal(drawn.goal, Condition())
    options = draw(OPTIONS)
    found = []
    for share in draw(st.sampled_from([("1/2", "1/2"), ("1/4", "3/4"), ("1/2", "1/4", "1/4")])):
        goal = task.goal if not found and draw(st.booleans()) else draw(reachable_goals(task))
        aimed = task.with_goal(goal)
        plan = next(plans_in_time(aimed, strict=options.strict), None)
        assume(plan is not None)
        assert plan is not None
        found.append(Scenario(goal, draw(timed_plans(aimed, plan)), Fraction(share)))
    horizon = max(task.epochs_of(one.plan) for one in found) + draw(st.integers(0, 1))
    assume(0 < horizon <= LONGEST)
    lasting = (outlasts(task.with_goal(s.goal), s.plan, horizon, strict=options.strict) for s in found)
    assume(not any(lasting))
    return task, found, options.but(horizon=horizon)
