"""Libraries of plans: read, replayed and scaled; what is wrong is said in one line.

Plans that the human may follow, each with a goal of its own, are answered, told and proved.
"""

import json
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.model import InputError, Result, UsageError
from serendipity.recognition.library import SCHEMA, plan_library
from serendipity_testing.builders import task as build

MAKE, PACK = {"probability": 1, "goal": ["coffee"], "plan": ["make h"]}, "pack h"

HOME = build(
    init="beans",
    goal="coffee lunch",
    actions={"make h": "beans -> coffee !beans", "pack h": "-> lunch", "help r": "-> lunch"},
)


def test_probabilities_add_up_to_1_and_plans_are_replayed(tmp_path: Path) -> None:
    plans: list[dict[str, Any]] = [
        {**MAKE, "name": "coffee", "probability": "1/2", "goal": ["(coffee)", "!beans"]},
        {"probability": 0.25, "plan": ["(pack h)", "(make h)"], "count": 3, "interval": [0.1, 0.6]},
        {**MAKE, "probability": 0},
    ]
    file = tmp_path / "plans.json"
    file.write_text(json.dumps({"schema": SCHEMA, "plans": plans}))
    found = plan_library(HOME, file)
    assert found == plan_library(HOME, plans)
    assert [(one.name, one.probability) for one in found] == [
        ("coffee", Fraction(2, 3)),
        ("plan 2", Fraction(1, 3)),
    ]
    assert [one.literals for one in found] == [("coffee", "!beans"), ("coffee", "lunch")]
    assert [[HOME.actions[i].name for i in one.plan] for one in found] == [["make h"], [PACK, "make h"]]


def test_plans_in_time_keep_their_waiting() -> None:
    morning = serendipity.example("morning")
    plan = serendipity.plan(morning, mode="individual")
    assert plan.human_plan is not None and plan.human_plan_times is not None
    told = plan.human_plan_times.entries(plan.human_plan)
    lines = [f"{(epoch - 1) * morning.epoch}: ({name})" for epoch, name in told]
    (one,) = plan_library(morning, [{"probability": 1, "plan": lines}])
    assert one.plan == morning.plan_from_names(told)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"plan": ["make b"]}, "plan 2, step 1: there is no action 'make b'"),
        ({"plan": ["make h", "make h"]}, "plan 2, step 2: 'make h' is not applicable: 'beans' is"),
        ({"plan": ["help r"]}, "plan 2, step 1: 'help r' is not an action that h can do alone"),
        ({"plan": [PACK]}, "plan 2: the goal does not hold after its last step 'pack h'"),
        ({"plan": []}, "plan 2: it has no step, and the goal does not hold"),
        ({"plan": [PACK, "(make h"]}, "plan 2, action 2: expected one action"),
        ({"plan": [PACK, "3: make h"]}, "plan 2, action 1: expected a time"),
        ({"plan": [[0, "make h"]]}, "plan 2, step 1: 'make h': expected an epoch from 1 on, got 0"),
        ({"plan": [[10**6 + 1, "make h"]]}, "plan 2, step 1: 'make h': expected an epoch from 1 to 1000000"),
        ({"plan": "make h"}, "plan 2: plan: expected a list of actions, got 'make h'"),
        ({"plan": None}, "plan 2: plan: expected a list of actions"),
        ({"goal": ["tea"]}, "plan 2: there is no fact 'tea'"),
        ({"goal": "coffee"}, "plan 2: goal: expected a list of facts"),
        ({"probability": None}, "plan 2: probability: expected a finite number, got None"),
        ({"probability": -1}, "plan 2: probability: expected a number of at least 0, got -1"),
        ({"name": 3}, "plan 2: name: expected a text"),
        ({"name": "plan 1"}, "plan 2: there are two plans named 'plan 1'"),
        ({"likelihood": 1}, "plan 2: unknown field 'likelihood': expected name, probability"),
    ],
)
def test_what_is_wrong_with_a_plan_is_said(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as caught:
        plan_library(HOME, [MAKE, {**MAKE, **changed}])
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "expected JSON: the file is empty"),
        ("[]", f"plans: expected a JSON object with the schema '{SCHEMA}'"),
        ("{}", f"plans: schema: expected '{SCHEMA}', got None"),
        ('{"schema": "serendipity.plans/2"}', "'serendipity.plans/2' is newer than"),
        (f'{{"schema": "{SCHEMA}", "plans": 1}}', "plans: expected a list, got 1"),
        (f'{{"schema": "{SCHEMA}", "plans": []}}', "plans: expected probabilities with a sum above 0"),
        (f'{{"schema": "{SCHEMA}", "plans": [3]}}', "plan 1: expected an object with probability and plan"),
    ],
)
def test_what_is_wrong_with_a_file_is_said(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "plans.json"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        plan_library(HOME, file)
    assert caught.value.file == str(file)
    assert message in caught.value.message


def test_a_number_is_no_library() -> None:
    with pytest.raises(UsageError, match="plans: expected a file, an object or a list of plans, got 5"):
        plan_library(HOME, 5)  # type: ignore[arg-type]


def test_plans_with_goals_of_their_own_are_proved() -> None:
    task = serendipity.example("room2")
    goals = {room: [f"conducted_triage commx {room}"] for room in ("room1", "room3", "room9")}
    alone = {
        room: serendipity.plan(task, goals=[{"name": room, "goal": goal}]).human_plan
        for room, goal in goals.items()
    }
    plans = [
        {"name": room, "probability": 1, "goal": goals[room], "plan": list(alone[room])} for room in goals
    ]
    by_plans = serendipity.plan(task, discount="0.9", plans=plans)
    by_goals = serendipity.plan(
        task, discount="0.9", goals=[{"name": room, "goal": goal} for room, goal in goals.items()]
    )
    assert (by_plans.cost, by_plans.objective) == (by_goals.cost, by_goals.objective)
    read = Result.from_dict(by_plans.to_dict())
    assert [scenario.goal for scenario in read.goals] == [None, *map(tuple, list(goals.values())[1:])]
    assert serendipity.verify(task, read).verdict == "proved"


def test_one_plan_is_a_given_one() -> None:
    task = serendipity.example("room2")
    plan = serendipity.plan(task, mode="individual").human_plan
    found = serendipity.plan(
        task, discount="0.9", plans=[{"name": "it", "probability": 1, "plan": list(plan)}]
    )
    known = serendipity.plan(task, discount="0.9", human_plan=plan)
    assert found.to_dict() | {"statistics": None} == known.to_dict() | {"statistics": None}


@pytest.mark.parametrize("more", [{"observed": ["go h"]}, {"beta": 2}, {"noise": "miss=0.1"}])
def test_what_tells_goals_goes_with_goals_only(more: dict[str, Any]) -> None:
    task = serendipity.example("room2")
    for plans in (None, [{"probability": 1, "plan": []}]):
        with pytest.raises(UsageError, match=f"^{next(iter(more))}: goes with goals only$"):
            serendipity.plan(task, plans=plans, **more)


@pytest.mark.long
def test_limits_hold_beside_plans_of_many_epochs() -> None:
    task = build(init="", goal="lunch", actions={"pack h": "-> lunch", "help r": "-> lunch"})
    plans = [{"name": str(epoch), "probability": 1, "plan": [[epoch, "pack h"]]} for epoch in (1, 20_000)]
    began = time.process_time()
    found = serendipity.plan(task, plans=plans, time_limit=1)
    assert (found.human_cost, time.process_time() - began < 6) == (1, True)


@pytest.mark.parametrize("asked", [{"risk": "worst"}, {"policy": "fixed"}], ids=str)
def test_what_says_something_of_several_plans_only_is_refused_of_one(asked: dict[str, Any]) -> None:
    task = serendipity.example("room2")
    with pytest.raises(UsageError, match=f"^{next(iter(asked))}: goes with goals, plans or ties 'watched'$"):
        serendipity.plan(task, **asked)
    one = [{"goal": [task.facts[i] for i in task.goal.positive]}]
    assert serendipity.plan(task, ties="watched", **asked).cost is not None
    assert serendipity.explain(task, serendipity.plan(task, goals=one, **asked)).answer.cost is not None


def test_a_session_is_asked_about_plans_again() -> None:
    task = serendipity.example("room2")
    plans = [{"probability": 1, "plan": list(serendipity.plan(task).human_plan or ())}]
    session = serendipity.Session(task)
    assert session.plan(plans=plans).cost == session.plan(plans=plans).cost
