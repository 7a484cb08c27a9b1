"""Where answers go: whole files or none, never in the place of what is read; stdout, stderr for the rest.

On full disks and closed streams: one line, exit 2, and no file that is torn, empty or alone.
"""

import json
import os
import stat
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import serendipity
from serendipity.cli.streams import output
from serendipity.model import Result, UsageError
from tests.cli.conftest import ROOT, Runs, assert_one_line
from tests.writing.full_disk import largest_file


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


@pytest.mark.usefixtures("answer")
@pytest.mark.parametrize(
    ("ending", "start"), [("html", b"<!doctype html>"), ("svg", b"<svg"), ("png", b"\x89PNG")]
)
def test_the_ending_chooses_the_form(ending: str, start: bytes, run: Runs, tmp_path: Path) -> None:
    if ending == "png":
        pytest.importorskip("matplotlib", reason="needs the extra 'plot'")
    done = run(f"show --example room2 help.json -o help.{ending}")
    assert (done.code, done.out, done.err) == (0, "", "")
    assert (tmp_path / f"help.{ending}").read_bytes().startswith(start)


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


def names(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


@pytest.mark.long
@pytest.mark.parametrize(
    ("command", "size", "fails"),
    [
        ("plan --example room2 -o answer.json", 1000, "answer.json"),
        ("interruptions --example room2 -o windows.json --heat-map map.svg", 50_000, "windows.json"),
        ("interruptions --example room2 -o windows.txt --heat-map map.svg", 20_000, "map.svg"),
        ("generate usar --rooms 30 -o new/building", 1900, "building"),
        ("show --example room2 help.json -o help.html", 2000, "help.html"),
        ("reproduce suite --modes individual --discounts 0 --journal j -o rows.csv", 100, "journal"),
        (
            "reproduce suite --modes individual --discounts 0 --report page.html -o rows.csv",
            2000,
            "page.html",
        ),
        (
            "bench --rooms 4 --seeds 1 --modes composite-inf --discounts 0 --repeat 1 --contenders search "
            "-o timings.csv --plot timings.svg",
            6000,
            "timings.svg",
        ),
    ],
)
def test_a_full_disk_leaves_nothing_behind(
    command: str, size: int, fails: str, run: Runs, tmp_path: Path
) -> None:
    if "--plot" in command:
        pytest.importorskip("matplotlib", reason="needs the extra 'plot'")
    if "help.json" in command:
        run("plan --example room2 -o help.json")
    serendipity.generate_usar(tmp_path / "suite/test1", preset="room2")
    before = names(tmp_path)
    with largest_file(size):
        done = run(command)
    assert_one_line(done, fails, "File too large")
    kept = ["rows.csv.journal"] if "--report" in command else []  # all the work is in it
    assert names(tmp_path) == sorted([*before, *kept])


def test_what_was_there_before_stays(run: Runs, tmp_path: Path) -> None:
    journal = tmp_path / "journal"
    serendipity.generate_usar(tmp_path / "suite/test1", preset="room2")
    call = "reproduce suite --modes individual --journal journal"
    assert run(f"{call} --discounts 0").code == 0
    before = journal.read_bytes()
    with largest_file(len(before) + 100):
        assert_one_line(run(f"{call} --discounts 0.5"), "journal", "File too large")
    assert journal.read_bytes() == before


@pytest.fixture
def shell(tmp_path: Path) -> Callable[[str], tuple[int, str]]:
    """Run a shell line in which `serendipity` is ours: its exit code, and what stderr says."""

    def runs(line: str) -> tuple[int, str]:
        program = f'serendipity() {{ "{sys.executable}" -m serendipity "$@"; }}; {line}'
        done = subprocess.run(
            ["bash", "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        return done.returncode, done.stderr

    return runs


@pytest.mark.parametrize("command", ["examples", "--help"])
def test_a_full_standard_output_is_one_line(command: str, shell: Callable[[str], tuple[int, str]]) -> None:
    code, told = shell(f"serendipity {command} > /dev/full")
    assert code == 2
    assert told == "Error: standard output can't be written: No space left on device\n"


@pytest.mark.long
def test_closed_streams_do_no_harm(tmp_path: Path, shell: Callable[[str], tuple[int, str]]) -> None:
    assert shell("serendipity examples >&-") == (2, "Error: standard output is closed\n")
    assert shell("serendipity plan --example room2 -o answer.json >&- 2>&- <&-") == (0, "")
    assert (tmp_path / "answer.json").read_text().startswith("{\n")
    assert shell("serendipity plan nowhere 2>&-; echo $? >&2") == (0, "2\n")
