"""Libraries of plans: read, replayed and scaled; what is wrong is said in one line."""

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.model import InputError, UsageError
from serendipity.recognition.library import SCHEMA, plan_library
from serendipity.testing.builders import task as build

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
