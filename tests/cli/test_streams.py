"""Full disks and closed streams: one line, exit 2, and no file that is torn, empty or alone."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import serendipity
from tests.cli.conftest import Runs, assert_one_line
from tests.writing.full_disk import largest_file


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
