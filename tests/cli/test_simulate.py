"""``serendipity simulate``: text and JSON, and what it complains about."""

import json
from pathlib import Path

import pytest

from serendipity.cli.app import main


@pytest.fixture
def answer(tmp_path: Path) -> Path:
    path = tmp_path / "help.json"
    assert main(["plan", "--example", "room5", "--discount", "0.9", "-o", str(path)]) == 0
    return path


def test_text_tells_the_story(answer: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "--example", "room5", str(answer)]) == 0
    text = capsys.readouterr().out
    assert "epoch 5\n  commx: move_reverse commx hall5 room5" in text
    assert text.splitlines()[-1].startswith("not realised with the observant human")


def test_json_holds_every_epoch(answer: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["simulate", "--example", "room5", str(answer), "--human-model", "local", "--format", "json"]
    assert main(call) == 0
    trace = json.loads(capsys.readouterr().out)
    assert trace["schema"] == "serendipity.trace/1"
    assert trace["realised"] is False
    assert [epoch["epoch"] for epoch in trace["epochs"]] == list(range(1, 14))
    assert trace["promised_cost"] == 11.5


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--example", "room5", "{answer}", "--human-model", "psychic"], "human_model: expected one of"),
        (["--example", "room5", "missing.json"], "can't be read"),
        (["{answer}", "domain.pddl"], "expected TASK and then RESULT.json"),
    ],
)
def test_wrong_input_is_one_line(
    answer: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], complaint: str
) -> None:
    assert main(["simulate", *(text.format(answer=answer) for text in arguments)]) == 2
    error = capsys.readouterr().err
    assert complaint in error
    assert error.count("\n") == 1
