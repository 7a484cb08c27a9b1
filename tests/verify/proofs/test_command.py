"""``verify --proof`` and ``check-proof`` as somebody types them."""

import json
from pathlib import Path

import pytest

from serendipity.cli.app import main


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("answers")
    for example in ("room2", "room7"):
        answer = str(folder / f"{example}.json")
        assert main(["plan", "--example", example, "--discount", "0.6", "--quiet", "-o", answer]) == 0
        proof = str(folder / f"{example}.proof.json.gz")
        assert main(["verify", "--example", example, answer, "--proof", proof, "--quiet"]) == 0
    return folder


def test_a_proof_holds_by_itself(answers: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check-proof", str(answers / "room2.proof.json.gz")]) == 0
    out = capsys.readouterr().out
    assert "every window, 13 epochs" in out
    assert "accepted, optimal: 1 program refuted, 1 leaf; whether of the claim's programs takes TASK" in out


def test_a_proof_is_that_of_its_result(answers: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["check-proof", str(answers / "room7.proof.json.gz"), "--example", "room7"]
    assert main([*words, str(answers / "room7.json"), "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["schema"], found["verdict"]) == ("serendipity.proof-check/1", "accepted")
    assert (found["claim"], found["compared"]) == ("no_opportunity", True)
    assert found["programs"][0].keys() == {"name", "columns", "rows", "leaves", "limit", "optimum"}


def test_another_task_s_proof_is_rejected(answers: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["check-proof", str(answers / "room7.proof.json.gz"), "--example", "room2"]
    assert main([*words, str(answers / "room2.json")]) == 1
    assert "rejected, no_opportunity: the proof is of 'no_opportunity', the result claims 'optimal'" in (
        capsys.readouterr().out
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--example", "room2"], "expected TASK and RESULT.json behind the proof, or neither"),
        (["room2.json"], "task: expected one of"),
        (["--example", "room2", "room2.json", "--time-limit", "soon"], "expected seconds, got 'soon'"),
    ],
)
def test_half_a_question(
    words: list[str],
    said: str,
    answers: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(answers)
    assert main(["check-proof", "room2.proof.json.gz", *words]) == 2
    error = capsys.readouterr().err
    assert (said in error, error.count("\n")) == (True, 1)


def test_no_time_is_no_verdict(answers: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check-proof", str(answers / "room2.proof.json.gz"), "--time-limit", "0"]) == 4
    assert capsys.readouterr().err.count("\n") == 1


def test_no_proof_no_file(answers: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wrong = json.loads((answers / "room2.json").read_text()) | {"cost": 1.0}
    (tmp_path / "wrong.json").write_text(json.dumps(wrong))
    proof = tmp_path / "proof.json"
    assert main(["verify", "--example", "room2", str(tmp_path / "wrong.json"), "--proof", str(proof)]) == 1
    assert f"{proof} is not written" in capsys.readouterr().err
    assert not proof.exists()
    assert main(["verify", "--example", "room2", str(answers / "room2.json"), "--proof", "/none/x.json"]) == 2
    assert "--proof: there is no folder /none" in capsys.readouterr().err


def test_a_proof_for_veripb_is_sent_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    proof = tmp_path / "help.pbp"
    proof.write_text("pseudo-Boolean proof version 2.0\n")
    assert main(["check-proof", str(proof)]) == 2
    assert "is for VeriPB: expected a proof file in JSON; run 'veripb" in capsys.readouterr().err
