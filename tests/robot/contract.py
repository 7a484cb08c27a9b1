"""What every adapter keeps to."""

from serendipity.execution import Execution
from serendipity.model import Task
from serendipity.robot import OUTCOMES, Adapter, Epoch, Order, Report
from tests.execution import living
from tests.execution.living import replayed

WALK = Order(("robot",), "move_reverse robot room4 room3")
LIFT = Order(("robot",), "pick_up_medkit robot mk2 room3")


def told(task: Task, adapter: Adapter, number: int, *orders: Order) -> list[Report]:
    """The reports of an epoch that begins where the task does."""
    return list(adapter.execute(Epoch(number, task.init, None, orders)))


def keeps_its_contract(task: Task, adapter: Adapter) -> Execution:
    """Live through the paper's III-C with robots that an adapter moves, and play the log again."""
    assert told(task, adapter, 1) == [], "a report for each order"
    run = living.told(task, discount="0.6", adapter=adapter)
    adapter.close()
    assert run.done
    for passed in run.passed:
        meant = (*passed.decided.actions, *passed.decided.offers)
        assert {each.order.action for each in passed.reports} <= {step.action for step in meant}
        assert all(each.report.outcome in OUTCOMES and each.report.seconds >= 0 for each in passed.reports)
        done = {each.order.action for each in passed.reports if each.report.outcome == "done"}
        robots = {step.action for step in passed.steps if "robot" in step.agents}
        assert done == robots, "what is done has taken place, and nothing else"
    replayed(task, run)
    return run
