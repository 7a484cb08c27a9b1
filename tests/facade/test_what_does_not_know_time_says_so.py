"""Calls that can't be answered in time yet say so in one line."""

import pytest

import serendipity
from serendipity.model import Options, Script, Task, UsageError
from serendipity.testing.builders import task


def slow() -> Task:
    """A task of one action that takes two epochs."""
    return task(goal="done", actions={"do h": " -> done @ 1 [2]", "help r": " -> done"})


def plain() -> Task:
    """The same in one epoch."""
    return task(goal="done", actions={"do h": " -> done", "help r": " -> done"})


def test_waiting_and_a_head_start_are_played() -> None:
    waiting = serendipity.plan(plain(), human_plan=[(3, "do h")])
    assert (waiting.status, waiting.horizon) == ("optimal", 3)
    assert serendipity.verify(plain(), waiting).verdict == "proved"
    begun = serendipity.plan(plain(), head_start=2)
    assert (begun.status, begun.horizon) == ("optimal", 3)
    for answer in (waiting, begun):
        played = serendipity.simulate(plain(), answer)
        assert played.realised and [epoch.did for epoch in played.epochs] == [None, None, "do h"]


def test_options_of_time_are_written_down_only_where_they_are_in_force() -> None:
    assert "waiting_cost" not in Options().to_dict()
    timed = Options(waiting_cost="0.5", head_start=7)
    assert Options.from_dict(timed.to_dict()) == timed


def test_scenarios_in_time_refuse_what_is_not_settled() -> None:
    one, goals = slow(), [{"name": name, "goal": ["done"]} for name in "ab"]
    plans = [{"probability": 1, "plan": [[epoch, "do h"]]} for epoch in (1, 2)]
    with pytest.raises(UsageError, match="noise: where a script or durations count"):
        serendipity.plan(one, goals=goals, observed=["do h"], noise="miss=0.1")
    for name, value in {"head_start": 1, "waiting_cost": 1, "suffix": "subplan"}.items():
        with pytest.raises(UsageError, match=f"{name}: in time, with several goals or plans, only"):
            serendipity.plan(one, plans=plans, **{name: value})
    undone = one.with_script(Script(facts=[(4, "!done")]))
    with pytest.raises(UsageError, match=r"plan 'plan 1' does not last until epoch 4: the goal"):
        serendipity.plan(undone, plans=plans, horizon=4)


def test_scenarios_may_differ_in_nothing_but_when() -> None:
    """The robot is through by epoch 1 in both, whoever begins when."""
    plans = [{"probability": 1, "plan": [[epoch, "do h"]]} for epoch in (2, 3)]
    answer = serendipity.plan(plain(), plans=plans, discount=1)
    assert (answer.cost, answer.human_cost, answer.horizon) == (0, 1, 3)
    assert [entry.human_plan_times.starts for entry in answer.goals] == [(2,), (3,)]
