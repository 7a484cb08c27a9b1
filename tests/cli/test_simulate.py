"""``serendipity simulate``: text and JSON, and what it complains about."""

import json

import pytest

from tests.cli.conftest import Runs, assert_one_line


@pytest.fixture
def room5(run: Runs) -> Runs:
    """Run command lines where ``help.json`` answers the example room5."""
    assert run("plan --example room5 --discount 0.9 -o help.json").code == 0
    return run


def test_text_tells_the_story(room5: Runs) -> None:
    text = room5("simulate --example room5 help.json").out
    assert "epoch 5\n  commx: move_reverse commx hall5 room5" in text
    assert text.splitlines()[-1].startswith("not realised with the observant human")


def test_json_holds_every_epoch(room5: Runs) -> None:
    trace = json.loads(room5("simulate --example room5 help.json --human-model local --format json").out)
    assert trace["schema"] == "serendipity.trace/1"
    assert trace["realised"] is False
    assert [epoch["epoch"] for epoch in trace["epochs"]] == list(range(1, 14))
    assert trace["promised_cost"] == 11.5


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ("--example room5 help.json --human-model psychic", "human_model: expected one of"),
        ("--example room5 missing.json", "can't be read"),
        ("help.json domain.pddl", "expected TASK and then RESULT.json"),
    ],
)
def test_wrong_input_is_one_line(room5: Runs, arguments: str, complaint: str) -> None:
    assert_one_line(room5(f"simulate {arguments}"), complaint)
