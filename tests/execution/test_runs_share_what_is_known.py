"""Runs of one task share tables and the plan from before the first epoch, and nothing of what happened."""

import pytest

import serendipity
from serendipity.execution import Execution
from serendipity.execution.robot_policy import RobotPolicy
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline


@pytest.mark.parametrize("human", ["observant", "local", "omniscient", "noisy:0.3"])
def test_runs_with_time_to_decide_are_those_without_a_deadline(human: str) -> None:
    task = serendipity.example("room2")
    settings = {"runs": 3, "discount": "0.9", "ties": "drawn"}
    timed = serendipity.execute(task, human, deadline=60, **settings)
    untimed = serendipity.execute(task, human, **settings)
    assert [(r.cost, r.human_cost, r.epochs) for r in timed.rows] == [
        (r.cost, r.human_cost, r.epochs) for r in untimed.rows
    ]


def test_robots_who_begin_again_know_nothing_of_what_has_happened_since() -> None:
    task = serendipity.example("room2")
    robots = RobotPolicy(task, Options(discount="0.9"), None, 1, told=False)  # type: ignore[arg-type]
    Execution(task, robots=robots)._asked(Deadline())
    ready = robots.again()
    first = Execution(task, discount="0.9", robots=ready.again())
    plan = first.decided.plan
    for name in ("move commx room13 hall8", "move_reverse commx hall8 hall7"):
        first.step(name)
    second = Execution(task, discount="0.9", robots=ready.again())
    assert second.decided.plan == plan and second.decided.cost == 11.4
