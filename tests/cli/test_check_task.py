"""``serendipity check-task``: text, JSON and exit codes, in every way of naming a task."""

import json
from pathlib import Path

import pytest

import serendipity
from tests.cli.conftest import Runs, assert_one_line

AGENTS = (
    "--agent commx=task/commx/domain.pddl,task/commx/problem.pddl "
    "--agent robot=task/robot/domain.pddl,task/robot/problem.pddl "
    "--team task/superagent/domain.pddl,task/superagent/problem.pddl"
)
PAIR = "pair/domain.pddl pair/problem.pddl --human commx --robot robot"


@pytest.fixture
def building(tmp_path: Path) -> Path:
    serendipity.generate_usar(tmp_path / "task", preset="room2")
    serendipity.generate_usar(tmp_path / "pair", preset="room2", layout="pair")
    return tmp_path


@pytest.mark.parametrize("named", ["--example room2", "task", AGENTS, PAIR])
def test_every_way_of_naming_a_task(named: str, building: Path, run: Runs) -> None:
    done = run(f"check-task {named} --format json")
    assert (done.code, done.err) == (0, "")
    report = json.loads(done.out)
    assert report["schema"] == "serendipity.task-report/1"
    assert sum(report["actions"].values()) == 353
    assert report["actions"]["hand_over"] == 84
    assert "predicate-unread" in {finding["rule"] for finding in report["findings"]}


def test_a_goal_out_of_reach_is_1(building: Path, run: Runs) -> None:
    for file in building.glob("task/*/problem.pddl"):
        file.write_text(file.read_text().replace("(at mk1 room2)", "").replace("(at mk2 room3)", ""))
    done = run("check-task task")
    assert done.code == 1
    assert "error: commx's goal can't be reached by all agents together" in done.out
    assert done.err == ""


def test_bad_files_are_2(building: Path, run: Runs) -> None:
    (building / "pair/problem.pddl").write_text("(define")
    assert_one_line(run(f"check-task {PAIR}"), "problem.pddl")
