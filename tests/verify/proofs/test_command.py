"""``verify --proof`` and ``check-proof`` as somebody types them."""

import json
from pathlib import Path

import pytest

import serendipity
from serendipity.cli.app import main
from serendipity_testing.cases import case_1
from tests.cli.conftest import Runs, assert_one_line


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("answers")
    for example in ("room2", "room7"):
        answer = str(folder / f"{example}.json")
        assert main(["plan", "--example", example, "--discount", "0.6", "--quiet", "-o", answer]) == 0
        proof = str(folder / f"{example}.proof.json.gz")
        assert main(["verify", "--example", example, answer, "--proof", proof, "--quiet"]) == 0
    return folder


def test_a_proof_holds_by_itself(answers: Path, run: Runs) -> None:
    done = run(f"check-proof {answers}/room2.proof.json.gz")
    assert done.code == 0
    assert "every window, 13 epochs" in done.out
    assert "accepted, optimal: 1 program refuted, 1 leaf; whether of the claim's programs takes" in done.out


def test_a_proof_is_that_of_its_result(answers: Path, run: Runs) -> None:
    task = f"--example room7 {answers}/room7.json"
    found = json.loads(run(f"check-proof {answers}/room7.proof.json.gz {task} --format json").out)
    assert (found["schema"], found["verdict"]) == ("serendipity.proof-check/1", "accepted")
    assert (found["claim"], found["compared"]) == ("no_opportunity", True)
    assert found["programs"][0].keys() == {"name", "columns", "rows", "leaves", "limit", "optimum"}


def test_another_task_s_proof_is_rejected(answers: Path, run: Runs) -> None:
    done = run(f"check-proof {answers}/room7.proof.json.gz --example room2 {answers}/room2.json")
    said = "rejected, no_opportunity: the proof is of 'no_opportunity', the result claims 'optimal'"
    assert (done.code, said in done.out) == (1, True)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--example room2", "expected TASK and RESULT.json behind the proof, or neither"),
        ("room2.json", "task: expected one of"),
        ("--example room2 room2.json --time-limit soon", "expected seconds, got 'soon'"),
    ],
)
def test_half_a_question(
    words: str, said: str, answers: Path, run: Runs, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(answers)
    assert_one_line(run(f"check-proof room2.proof.json.gz {words}"), said)


def test_no_time_is_no_verdict(answers: Path, run: Runs) -> None:
    done = run(f"check-proof {answers}/room2.proof.json.gz --time-limit 0")
    assert (done.code, done.err.count("\n")) == (4, 1)


def test_no_proof_no_file(answers: Path, run: Runs) -> None:
    wrong = json.loads((answers / "room2.json").read_text()) | {"cost": 1.0}
    Path("wrong.json").write_text(json.dumps(wrong))
    done = run("verify --example room2 wrong.json --proof proof.json")
    assert (done.code, "proof.json is not written" in done.err) == (1, True)
    assert not Path("proof.json").exists()
    done = run(f"verify --example room2 {answers}/room2.json --proof /none/x.json")
    assert_one_line(done, "--proof: there is no folder /none")


def test_a_proof_is_not_named_as_a_problem(answers: Path, run: Runs) -> None:
    done = run(f"verify --example room2 {answers}/room2.json --proof help.opb")
    assert_one_line(done, "proof: expected a name that ends in .pbp for VeriPB, got 'help.opb'")
    with pytest.raises(serendipity.UsageError, match="ends in"):
        serendipity.verify(case_1(), serendipity.plan(case_1()), proof="help.opb")
    assert not Path("help.opb").exists()


def test_a_proof_for_veripb_is_sent_there(run: Runs) -> None:
    Path("help.pbp").write_text("pseudo-Boolean proof version 2.0\n")
    assert_one_line(run("check-proof help.pbp"), "is for VeriPB: expected a proof file in JSON; run 'veripb")
