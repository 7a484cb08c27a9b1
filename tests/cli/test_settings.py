"""Settings: found from the working directory upwards, overridden by the command line, wrong ones one line."""

import json
import os
from pathlib import Path

import pytest

import serendipity
from serendipity.cli.on_demand import NAMES
from serendipity.cli.options.settings import COMMANDS
from tests.cli.conftest import Runs, assert_one_line

PLAN = "plan --example room2 --format json"


def options(run: Runs, command: str = PLAN) -> dict[str, object]:
    done = run(command)
    assert (done.code, done.err) == (0, "")
    found: dict[str, object] = json.loads(done.out)["options"]
    return found


@pytest.mark.parametrize("name", ["serendipity.toml", "pyproject.toml"])
def test_options_are_set_and_overridden(name: str, run: Runs) -> None:
    table = "[tool.serendipity]\n" if name == "pyproject.toml" else ""
    Path(name).write_text(
        f'{table}discount = 0.6\nwindow_weight = "1/3"\nmode = "communication"\nkeep_prefix = true\n'
    )
    found = options(run)
    assert (found["discount"], found["window_weight"]) == (0.6, "1/3")
    assert (found["mode"], found["keep_prefix"]) == ("communication", True)
    assert options(run, f"{PLAN} --discount 0.9")["discount"] == 0.9
    assert options(run, f"--no-settings {PLAN}")["discount"] == 0.0


def test_the_nearest_folder_decides(run: Runs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    inner = tmp_path / "a" / "b"
    inner.mkdir(parents=True)
    (tmp_path / "serendipity.toml").write_text("discount = 0.1\n")
    (tmp_path / "a" / "pyproject.toml").write_text("[project]\nname = 'serendipity'\n")
    monkeypatch.chdir(inner)
    assert options(run)["discount"] == 0.1  # a pyproject.toml without our table is none of ours
    for foreign in (b"[tool.serendipity-more]\ndiscount = 3\n", b"# [tool.serendipity]\n", b"no TOML \xff"):
        (tmp_path / "a" / "pyproject.toml").write_bytes(foreign)
        assert options(run)["discount"] == 0.1
    (tmp_path / "a" / "pyproject.toml").write_text("[tool.serendipity]\ndiscount = 0.2\n")
    assert options(run)["discount"] == 0.2
    (tmp_path / "a" / "serendipity.toml").write_text("max_window = 3\n")
    found = options(run)
    assert (found["discount"], found["max_window"]) == (0.0, 3)


def test_agents_are_set(run: Runs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    serendipity.generate_usar(tmp_path / "pair", preset="room2", layout="pair")
    serendipity.generate_usar(tmp_path / "folder", preset="room2")
    pairs = {
        name: f'["folder/{name}/domain.pddl", "folder/{name}/problem.pddl"]'
        for name in ("commx", "robot", "superagent")
    }
    Path("serendipity.toml").write_text(
        f'human = "commx"\nrobots = ["robot"]\ndiscount = 0.6\nteam = {pairs["superagent"]}\n'
        f"[agents]\ncommx = {pairs['commx']}\nrobot = {pairs['robot']}\n"
    )
    (tmp_path / "sub").mkdir()
    monkeypatch.chdir(tmp_path / "sub")
    for task in ("../pair/domain.pddl ../pair/problem.pddl", "../folder", "", "--example room2"):
        done = run(f"plan {task} --format json -o help.json")
        assert (done.code, done.err) == (0, ""), task
        told = json.loads(Path("help.json").read_text())
        assert (told["human"], told["cost"]) == ("commx", 12.6), task
    assert run("verify help.json").code == 0
    assert run("check-task").code == 0
    assert run("execute --human observant").code == 0
    assert_one_line(run("plan --human nobody"), "nobody")


def test_options_go_where_they_mean_the_same(run: Runs) -> None:
    Path("serendipity.toml").write_text('ties = "robust"\nhuman_model = "omniscient"\ntime_limit = 20\n')
    assert options(run)["ties"] == "robust"
    assert run(f"{PLAN} -o help.json").code == 0
    assert run("simulate --example room2 help.json").code == 0
    assert run("execute --example room2 --discount 0.6").code == 0
    assert run("interruptions --example room2").code == 0
    assert set(COMMANDS) <= set(NAMES)


@pytest.mark.long
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("windowweight = 3", ("windowweight: there is no such setting", "window_weight")),
        ('discount = "much"', ("discount: expected a finite number, got 'much'",)),
        ("discount = 2", ("discount: expected a number in [0, 1], got 2",)),
        ("discount = [0.1]", ("discount: expected a text, a number, true or false, got [0.1]",)),
        ("discount = true", ("discount: expected a number",)),
        ("mode = 3", ("mode: expected one of serendipity, individual",)),
        ('keep_prefix = "yes"', ("keep_prefix: expected true or false, got 'yes'",)),
        ("max_ties = 2.5", ("max_ties: expected a whole number",)),
        ('time_limit = "soon"', ("time_limit: expected seconds",)),
        ("human = 3", ("human: expected a name, got 3",)),
        ('robots = "robot"', ("robots: expected a list of names, got 'robot'",)),
        ('agents = ["a"]', ("agents: expected a table of NAME",)),
        ('agents = {a = "domain.pddl"}', ('agents.a: expected ["DOMAIN", "PROBLEM"], got',)),
        ('team = ["d", "p"]', ("team: expected agents beside it",)),
        ("discount = \nmode", ("expected TOML", "line 1")),
        ("discount = " + "[" * 2000 + "]" * 2000, ("expected TOML", "nested too deeply")),
    ],
)
@pytest.mark.parametrize("name", ["serendipity.toml", "pyproject.toml"])
def test_wrong_settings_are_one_line(name: str, text: str, words: tuple[str, ...], run: Runs) -> None:
    shared = name == "pyproject.toml"
    Path(name).write_text(f"[tool.serendipity]\n{text}\n" if shared else text)
    lines = tuple(word.replace("line 1", "line 2") if shared else word for word in words)
    assert_one_line(run(PLAN), name, *lines)
    if shared and "TOML" not in words[0]:
        assert "pyproject.toml: tool.serendipity." in run(PLAN).err
    assert run(f"--no-settings {PLAN}").code == 0
    assert run("examples").code == 0  # is about no task


def test_settings_that_do_not_go_together_are_named(run: Runs) -> None:
    Path("serendipity.toml").write_text('human_model = "observant"\n')
    told = run("plan --example room2 --mode composite")
    words = "human_model: 'observant' is for serendipity mode only", "(settings: ", "serendipity.toml)"
    assert_one_line(told, *words)


def test_files_that_can_not_be_read_are_one_line_and_others_are_told_in_the_log(run: Runs) -> None:
    Path("serendipity.toml").write_bytes(b"mode = '\xff'")
    assert_one_line(run(PLAN), "serendipity.toml: expected a text in UTF-8")
    Path("serendipity.toml").write_text("discount = 0.6\n")
    assert "settings from" in run(f"{PLAN} -v").err


def test_a_working_directory_that_is_gone_has_no_settings(
    run: Runs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    assert run("plan --example room2").code == 0
    os.chdir(tmp_path)
