"""An answer never takes the place of what it is made of, nor of another answer."""

import json
from pathlib import Path

import pytest

import serendipity
from tests.cli.conftest import Runs, assert_one_line

TASK = "domain.pddl problem.pddl --human commx --robot robot"


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, bytes]:
    """A task, a result of it, its human's plan and a proof, all in the working directory."""
    monkeypatch.chdir(tmp_path)
    serendipity.generate_usar(tmp_path, preset="room2", layout="pair")
    task = serendipity.load_pddl("domain.pddl", "problem.pddl", human="commx", robots=["robot"])
    result = serendipity.plan(task)
    (tmp_path / "help.json").write_text(json.dumps(result.to_dict()))
    (tmp_path / "human.txt").write_text("\n".join(result.human_plan or ()))
    (tmp_path / "goals.txt").write_text("1: conducted_triage commx room1\n")
    return {path.name: path.read_bytes() for path in tmp_path.iterdir()}


@pytest.mark.parametrize(
    ("command", "option", "file"),
    [
        (f"plan {TASK} -o problem.pddl", "-o", "problem.pddl"),
        (f"plan {TASK} -o ./domain.pddl", "-o", "domain.pddl"),
        (f"plan {TASK} --human-plan human.txt --save-plan human.txt", "--save-plan", "human.txt"),
        ("plan --agent commx=domain.pddl,problem.pddl -o problem.pddl", "-o", "problem.pddl"),
        ("plan --agent commx=a,b --team domain.pddl,problem.pddl -o domain.pddl", "-o", "domain.pddl"),
        (f"verify {TASK} help.json --proof help.json", "--proof", "help.json"),
        (f"verify {TASK} help.json --proof t.pbp -o t.opb", "-o", "--proof"),
        (f"verify {TASK} help.json --proof t.pbp -o t.v1.pbp", "-o", "--proof"),
        (f"verify {TASK} help.json --proof t.pbp -o t-2.opb", "-o", "--proof"),
        ("reproduce . --tables t -o t2.csv", "-o", "--tables"),
        ("front --example room2 -o new.svg --picture new.svg", "-o", "--picture"),
        (f"verify {TASK} help.json -o help.json", "-o", "help.json"),
        (f"show {TASK} help.json -o link.html", "-o", "link.html"),
        (f"explain {TASK} help.json -o help.json", "-o", "help.json"),
        ("check-proof help.json -o help.json", "-o", "help.json"),
        ("recognise --example room2 --goals goals.txt -o goals.txt", "-o", "goals.txt"),
        ("execute --example room2 --replay help.json --log help.json", "--log", "help.json"),
        ("plan --example room2 --save-plan new.txt -o new.txt", "-o", "--save-plan"),
    ],
)
def test_files_stay_what_they_are(
    command: str, option: str, file: str, files: dict[str, bytes], run: Runs
) -> None:
    Path("link.html").symlink_to("help.json")
    assert_one_line(run(command), f"{option}: expected another file than {file}")
    Path("link.html").unlink()
    assert {path.name: path.read_bytes() for path in Path().iterdir()} == files


def test_a_device_may_be_named_twice(run: Runs) -> None:
    done = run("plan --example room2 --save-plan /dev/null -o /dev/null")
    assert (done.code, done.out, done.err) == (0, "", "")


def test_an_older_answer_may_be_replaced(run: Runs) -> None:
    for _ in range(2):
        assert run("plan --example room2 -o room2").code == 0
    assert Path("room2").read_text()
