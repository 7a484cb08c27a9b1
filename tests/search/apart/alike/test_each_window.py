"""Each window by itself: told by numbers, it comes to what robots one by one come to."""

from random import Random

from search.short_windows.independent.alike.robots import CountedRobots
from search.short_windows.independent.alike.tally import tally
from search.short_windows.independent.one_window import RobotsApart
from search.short_windows.independent.short_windows import Robots
from search.short_windows.independent.window import ACTION, Window
from search.call.context import SearchContext
from search.packed.cost_vector import FAR, INFINITE_KEY
from search.packed.operators import Operator
from search.call.prepared_task import PreparedTask
from serendipity.model import Options
from serendipity.model.resources.deadline import Deadline
from tests.search.short_windows.independent.alike.surveys import survey


def _least(window: Window, limit: int) -> int:
    """The least key of all that robots can leave behind."""
    while window.is_open(limit):
        window.look(limit)
    return min(window.found, INFINITE_KEY)


def test_windows_of_every_epoch_come_to_the_same() -> None:
    """Also where the human has begun with a thing: that is no longer like the others."""
    compared = begun = 0
    for seed in range(120):
        dice = Random(f"windows {seed}")
        task = survey(dice, dice.choice((4, 5)), dice.choice((1, 1, 2)))
        options = Options(mode="serendipity", discount=dice.choice(["0", "1/2", "9/10"]))
        context = SearchContext(PreparedTask(task), options, Deadline())
        optimal = context.canonical_plan()
        if optimal is None or not optimal.actions:
            continue
        plan = optimal.actions

        def amount(op: Operator, context: SearchContext = context) -> int:
            return context.weights.scaled_cost(op) * ACTION + 1

        counted = tally(context.packed, context.relevant, context.deadline)
        if counted is None:
            continue
        numbers = CountedRobots(context, plan, counted, amount)
        steps = [context.packed.op(action) for action in plan]
        apart = RobotsApart(context, steps, {robot.agents: {} for robot in context.packed.others}, amount)
        both: tuple[Robots, Robots] = numbers, apart
        base, limit = (
            context.packed.init,
            context.amount_key(3 * context.task.cost_of(plan).__ceil__() * ACTION * 10),
        )
        for step in steps:
            one, other = (robots.window(base, 0, limit) for robots in both)
            assert _least(one, limit) == _least(other, limit)
            compared += 1
            begun += any(left.begun for left in one._left)
            for robots in both:
                robots.follow(step, FAR)
            base = base & step.keep | step.put
    assert compared > 80
    assert begun > 10
