"""The authors' USAR files, and those of silent assistance, load as they should."""

from fractions import Fraction
from pathlib import Path

import pytest

from benchmarks.problems import silent, silent_task
from serendipity import load


def test_first_published_task(usar200: Path) -> None:
    task = load(usar200 / "test1")
    assert task.agents == ("commx", "robot")
    assert task.agents[task.human] == "commx"
    assert task.warnings == ()
    assert not task.robot_goal
    start = ["at_commx_room3", "at_mk1_room5", "at_mk2_room1", "at_robot_hall2"]
    assert sorted(task.facts[f] for f in task.init) == start
    assert [task.facts[f] for f in task.goal.positive] == ["conducted_triage_commx_room13"]
    assert not any("noop" in a.name for a in task.actions)
    assert {a.cost for a in task.actions} == {Fraction(1)}
    joint = [a.name for a in task.actions if a.joint]
    assert len(joint) == 2 * 2 * 21
    assert all(name.startswith("hand_over") for name in joint)
    groups = {task.facts[v.facts[0]].rsplit("_", 1)[0]: len(v.facts) for v in task.variables if not v.boolean}
    assert groups == {"at_commx": 21, "at_robot": 21, "at_mk1": 23, "at_mk2": 23}


@pytest.mark.long
def test_all_published_tasks_load_without_a_warning(usar200: Path) -> None:
    folders = [path for path in usar200.iterdir() if path.is_dir()]
    assert len(folders) == 200
    for folder in folders:
        task = load(folder)
        assert task.warnings == ()
        assert len(task.actions) == 353


@pytest.mark.parametrize(
    ("domain", "problems"),
    [
        ("car_assistance1", 20),
        ("teleport_assistance1", 40),
        ("termes_assistance1", 4),
        ("visitall_assistance", 10),
    ],
)
def test_silent_assistance_loads(spa: Path, domain: str, problems: int) -> None:
    tasks = [silent_task(*files) for name, *files in silent(spa) if name.startswith(domain)]
    assert len(tasks) == problems
    for task in tasks:
        assert task.agents == ("prime", "supporter")
        assert task.human == 0
        assert task.goal
        assert task.human_actions
        assert any(a.participants == (1,) for a in task.actions)
        assert not any(a.joint for a in task.actions)
        assert task.warnings == ()


def test_actions_that_share_a_name_keep_their_owners(spa: Path) -> None:
    files = {name: pair for name, *pair in silent(spa)}
    task = silent_task(*files["termes_assistance1/0"])
    owners = {a.participants for a in task.actions if a.name.split()[0] == "pick-up-block"}
    assert (1,) in owners
    names = {a.name.split()[0] for a in task.actions if a.participants == (0,)}
    assert "move" in names
