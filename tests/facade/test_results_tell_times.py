"""Results in time: how long actions take, when the human's begin, and what bystanders do."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import serendipity
from serendipity import PlanError, Result, Script, Task, UsageError
from serendipity.cli.files.plans import plan_file, timed_plan
from serendipity.model import Condition, Options, PlanTimes
from serendipity.model.task.plans_in_time import times_of
from serendipity_testing.builders import task
from serendipity_testing.call import Call
from serendipity_testing.strategies.time import calls_in_time
from tests.search.exact_answers import proved

DAY = {
    "walk h": "bed -> !bed / door @ 3 [2]",
    "leave h": "door open -> out !door",
    "open r": "-> open @ 2 [2]",
    "stroll c": "-> strolled @ 1 [3]",
}


def day() -> Task:
    """Somebody whose door is shut until epoch 9, a robot that can open it, and Carol, who strolls."""
    built = task(agents="h r c", init="bed", goal="out", actions=DAY)
    return built.with_script(Script(facts=[(9, "open")], people={"c": [(2, "stroll c")]}))


def answered(call: Call) -> Result:
    """The answer to a call that is one; others are not drawn."""
    try:
        return serendipity.plan(call.task, human_plan=call.human_entries, **call.keywords())
    except (UsageError, PlanError):
        assume(False)
        raise


@given(calls_in_time())
def test_results_come_back(call: Call) -> None:
    answer = answered(call)
    assert Result.from_dict(json.loads(answer.to_json())) == answer
    if answer.human_plan is None:
        return
    plan = call.task.plan_from_names(answer.human_entries or ())
    times = times_of(call.task, plan)
    assert answer.human_plan_times == (None if times.plain else times)
    ends = [step.end for step in answer.plan or ()]
    assert not isinstance(answer.horizon, int) or max(ends, default=0) <= answer.horizon


@given(calls_in_time(modes=["individual"]), st.fractions(Fraction(1, 997), 60, max_denominator=997))
def test_plan_files_come_back(tmp_path_factory: pytest.TempPathFactory, call: Call, epoch: Fraction) -> None:
    one = replace(call.task, epoch=epoch, known_variables=call.task.variables)
    answer = answered(replace(call, task=one, human_plan=None))
    assume(answer.plan is not None)
    file = tmp_path_factory.getbasetemp() / "alone.plan"
    file.write_text(plan_file(one, answer))
    assert one.plan_from_names(timed_plan(file, one)) == one.plan_from_names(answer.human_entries or ())


def test_a_day_is_told_with_its_times(tmp_path: Path) -> None:
    answer = serendipity.plan(day(), discount="0.5", human_plan=[(4, "walk h"), (11, "leave h")])
    assert (answer.human_plan, answer.human_plan_times) == (
        ("walk h", "leave h"),
        PlanTimes(starts=(4, 11), durations=(2, 1), epochs=11),
    )
    assert answer.bystanders == {"c": (serendipity.PlanStep(2, ("c",), "stroll c", 0.0, 3),)}
    table = str(answer).split("\n\n")[1].splitlines()
    assert [line.split() for line in table] == [
        ["epoch", "h", "r", "c", "(bystander)"],
        ["2", "stroll", "c", "[3]"],
        ["4", "walk", "h", "[2]"],
        ["11", "leave", "h"],
        ["cost", "4", "0", "0"],
    ]
    lines = plan_file(replace(day(), epoch=Fraction(1, 2)), answer).splitlines()
    assert lines[1:-1] == [
        "; c: 0.500: (stroll c) [1.500]",
        "1.500: (walk h) [1.000]",
        "5.000: (leave h) [0.500]",
    ]


def test_without_time_nothing_is_added() -> None:
    written = serendipity.plan(serendipity.example("room2"), discount=0.6).to_dict()
    assert not {"human_plan_times", "bystanders"} & written.keys()
    assert all("duration" not in step for step in written["plan"])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"starts": [1]}, "times: expected as many starts as durations, got 1 and 2"),
        ({"starts": [4, 5]}, "times: expected an epoch from 6 on, got 5"),
        ({"epochs": 9}, "times: expected at least 10 epochs, got 9"),
        ({"durations": [2, 0]}, "human_plan_times.durations[1]: expected a number of epochs from 1"),
        ({"starts": [4], "durations": [2]}, "human_plan_times: expected 2 starts, got 1"),
        ({"more": 1}, "human_plan_times: expected an object with starts, durations, epochs only"),
    ],
)
def test_other_times_are_refused(changes: dict[str, Any], message: str) -> None:
    written = serendipity.plan(day(), human_plan=[(4, "walk h"), (10, "leave h")]).to_dict()
    written["human_plan_times"] |= changes
    with pytest.raises(serendipity.InputError) as caught:
        Result.from_dict(written)
    assert str(caught.value).startswith(f"result: {message}")


def test_robots_own_goals_have_epochs_without_a_horizon() -> None:
    """All of it was to begin with the epoch in which the human's plan is over."""
    slow = task(goal="", actions={"wash r": "-> washed @ 1 [2]", "dry r": "washed -> dry"})
    slow = slow.with_goal(slow.goal, Condition((slow.facts.index("dry"),)))
    answer = serendipity.plan(slow, mode="composite", horizon="inf")
    assert [(step.epoch, step.action) for step in answer.plan or ()] == [(1, "wash r"), (3, "dry r")]
    assert serendipity.verify(slow, answer).verdict != "refuted"


PLAIN = task(goal="done", actions={"do h": " -> done", "help r": " -> done"})


def test_waiting_and_a_head_start_are_played() -> None:
    for answer in (proved(PLAIN, human_plan=[(3, "do h")]), serendipity.plan(PLAIN, head_start=2)):
        assert (answer.status, answer.horizon) == ("optimal", 3)
        played = serendipity.simulate(PLAIN, answer)
        assert played.realised and [epoch.did for epoch in played.epochs] == [None, None, "do h"]


def test_options_of_time_are_written_down_only_where_they_are_in_force() -> None:
    assert "waiting_cost" not in Options().to_dict()
    timed = Options(waiting_cost="0.5", head_start=7)
    assert Options.from_dict(timed.to_dict()) == timed


def test_scenarios_may_differ_in_nothing_but_when() -> None:
    """The robot is through by epoch 1 in both, whoever begins when."""
    plans = [{"probability": 1, "plan": [[epoch, "do h"]]} for epoch in (2, 3)]
    answer = serendipity.plan(PLAIN, plans=plans, discount=1)
    assert (answer.cost, answer.human_cost, answer.horizon) == (0, 1, 3)
    assert [entry.human_plan_times.starts for entry in answer.goals] == [(2,), (3,)]
