"""Runs of one task share tables and the plan from before the first epoch, and nothing of what happened."""

import pytest

import serendipity


@pytest.mark.parametrize("human", ["observant", "local", "omniscient", "noisy:0.3"])
def test_runs_with_time_to_decide_are_those_without_a_deadline(human: str) -> None:
    task = serendipity.example("room2")
    settings = {"runs": 3, "discount": "0.9", "ties": "drawn"}
    timed = serendipity.execute(task, human, deadline=60, **settings)
    untimed = serendipity.execute(task, human, **settings)
    assert [(r.cost, r.human_cost, r.epochs) for r in timed.rows] == [
        (r.cost, r.human_cost, r.epochs) for r in untimed.rows
    ]
