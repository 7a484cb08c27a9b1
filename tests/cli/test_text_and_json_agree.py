"""Explanations, simulations and fronts as text and as JSON, which says what it was made of."""

import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity.model.json_text import json_text
from tests.cli.conftest import Runs, assert_one_line


def test_an_explanation_says_the_same_in_both(run: Runs) -> None:
    shown = run("explain --example room2 --discount 0.6")
    assert (shown.code, shown.err) == (0, "")
    data = json.loads(run("explain --example room2 --discount 0.6 --format json").out)
    assert data["schema"] == "serendipity.explanation/1"
    lines = [line.strip() for line in shown.out.splitlines() if line.startswith("  ")]
    assert lines == [sentence["text"] for sentence in data["sentences"]]
    topics = [line for line in shown.out.splitlines() if line and not line.startswith(" ")]
    assert topics == list(dict.fromkeys(sentence["topic"] for sentence in data["sentences"]))
    assert data["break_even_discount"]["exact"] == "1/2"
    assert (data["human_part"], data["robot_part"], data["cost"]) == (11, 1.6, 12.6)


def test_a_result_is_explained(run: Runs) -> None:
    assert run("plan --example room7 --discount 0.6 -o answer.json").code == 0
    from_file = run("explain --example room7 answer.json")
    assert from_file.code == 0
    assert from_file.out == run("explain --example room7 --discount 0.6").out


def test_a_doctored_result_is_refused(run: Runs, answer: dict[str, object]) -> None:
    assert_one_line(run("explain --example room2 help.json --discount 0.6"), "got both")
    Path("help.json").write_text(json.dumps(answer | {"cost": 12}))
    assert_one_line(run("explain --example room2 help.json"), "help.json", "no answer to this task")


@pytest.fixture
def room5(run: Runs) -> Runs:
    """Run command lines where ``help.json`` answers the example room5."""
    assert run("plan --example room5 --discount 0.9 -o help.json").code == 0
    return run


def test_a_simulation_tells_the_story(room5: Runs) -> None:
    text = room5("simulate --example room5 help.json").out
    assert "epoch 5\n  commx: move_reverse commx hall5 room5" in text
    assert text.splitlines()[-1].startswith("not realised with the observant human")


def test_a_simulation_holds_every_epoch(room5: Runs) -> None:
    trace = json.loads(room5("simulate --example room5 help.json --human-model local --format json").out)
    assert trace["schema"] == "serendipity.trace/1"
    assert trace["realised"] is False
    assert [epoch["epoch"] for epoch in trace["epochs"]] == list(range(1, 14))
    assert trace["promised_cost"] == 11.5


def test_the_front_on_the_command_line(run: Runs) -> None:
    asked = "front --example flights --discount 0.9 --disturbance "
    shown = run(f"{asked} ask=1 --format json --picture front.svg")
    assert (shown.code, '"schema": "serendipity.front/1"' in shown.out) == (0, True)
    assert "ask 1, meet 0, sight 0" in run(f"{asked} ask=1").out


def test_the_front_over_goals_on_the_command_line(run: Runs) -> None:
    Path("goals.txt").write_text("0.5: conducted_triage commx room1\n0.5: at commx hall1\n")
    asked = "front --example room2 --discount 0.9"
    shown = run(f"{asked} --goals goals.txt --verify --format csv")
    assert (shown.code, shown.out.count("proved")) == (0, 2)
    regret = run(f"{asked} --goals goals.txt --risk regret")
    assert regret.out.startswith("commx alone: greatest regret ")


scalars = (
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()
)
values = st.recursive(
    scalars, lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner), max_leaves=5
)


@given(st.dictionaries(st.text(), values, max_size=3))
def test_it_reads_as_it_was(value: dict[str, object]) -> None:
    assert json.loads(json_text(value)) == value


@pytest.mark.parametrize(
    ("value", "error"), [(math.nan, ValueError), ([-math.inf], ValueError), ({1}, TypeError)]
)
def test_what_is_no_json_is_not_written(value: object, error: type[Exception]) -> None:
    with pytest.raises(error):
        json_text({"a": value})
