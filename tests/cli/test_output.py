"""Where answers go: whole files or none, stdout, stderr for the rest."""

import json
import os
import stat
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import serendipity
from serendipity.cli.streams import output
from serendipity.model import Result, UsageError
from tests.cli.conftest import ROOT, Runs


def test_a_file_is_written_whole_with_usual_permissions(tmp_path: Path) -> None:
    target = tmp_path / "answer.json"
    output.write_answer("one\n", target)
    (tmp_path / "plain").write_text("")
    assert target.read_text() == "one\n"
    assert stat.S_IMODE(target.stat().st_mode) == stat.S_IMODE((tmp_path / "plain").stat().st_mode)
    target.chmod(0o640)
    output.write_answer("two\n", target)
    assert target.read_text() == "two\n"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_a_failed_write_leaves_the_old_file_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "answer.json"
    target.write_text("old")

    def full(path: Path, other: Path) -> Path:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(UsageError, match="No space left"):
        output.write_answer("new", target)
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_a_folder_in_the_way_of_the_last_of_several_leaves_none(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    with pytest.raises(UsageError, match="b can't be written: Is a directory"):
        output.write_answers([output.Answer("text", tmp_path / name) for name in "ab"])
    assert list(tmp_path.iterdir()) == [tmp_path / "b"]


def test_a_link_is_followed_and_a_device_is_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "answer")
    output.write_answer("text", tmp_path / "link")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "answer").read_text() == "text"
    output.write_answer("text", Path(os.devnull))
    assert stat.S_ISCHR(Path(os.devnull).stat().st_mode)


@pytest.mark.parametrize(
    ("words", "is_json"),
    [
        ("-o answer.json", True),
        ("-o answer.txt", False),
        ("-o answer.txt --format json", True),
        ("-o answer.json --format text", False),
    ],
)
def test_the_format_follows_the_option_then_the_file(words: str, is_json: bool, run: Runs) -> None:
    done = run(f"plan --example room2 {words}")
    assert (done.code, done.out, done.err) == (0, "", "")
    text = Path(words.split()[1]).read_text()
    assert text.startswith("{") == is_json


def test_the_json_is_the_result(run: Runs) -> None:
    read = Result.from_dict(json.loads(run("plan --example room2 --discount 0.6 --format json").out))
    expected = serendipity.plan(serendipity.example("room2"), discount=0.6)
    same = {"statistics": {}}
    assert replace(read, **same) == replace(expected, **same)


def test_warnings_go_to_stderr_unless_quiet(run: Runs) -> None:
    serendipity.generate_usar("task", preset="room2")
    robot = Path("task/robot/problem.pddl")
    robot.write_text(robot.read_text().replace("(at mk2 room3)", ""))
    loud, quiet = run("plan task"), run("plan task --quiet")
    assert loud.err.startswith("Warning: ")
    assert "at mk2 room3" in loud.err
    assert quiet.err == ""
    assert [line for line in loud.out.splitlines() if "ms" not in line] == [
        line for line in quiet.out.splitlines() if "ms" not in line
    ]


def test_a_reader_that_stops_early_is_no_error() -> None:
    program = f"{sys.executable} -m serendipity plan --example room2 | true; exit ${{PIPESTATUS[0]}}"
    given = {"cwd": ROOT, "stdin": subprocess.DEVNULL}
    done = subprocess.run(["bash", "-c", program], capture_output=True, text=True, check=False, **given)
    assert (done.returncode, done.stderr) == (0, "")
