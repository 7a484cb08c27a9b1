"""``show`` writes the picture that the file's ending names, and says in one line what is wrong."""

from pathlib import Path

import pytest

from tests.cli.conftest import Runs, assert_one_line


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


@pytest.mark.usefixtures("answer")
@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("room2 help.json", ["-o", ".html"]),
        ("room2 help.json -o help.gif", ["-o", "help.gif"]),
        ("room2 help.json -o help.html --epoch 3", ["--epoch"]),
        ("room2 help.json -o help.svg --epoch 99", ["epoch", "99"]),
        ("room2 help.json -o help.svg --scenario attic", ["scenario", "none", "attic"]),
        ("room7 help.json -o help.svg", ["help.json", "not applicable"]),
        ("room2 absent.json -o help.svg", ["absent.json"]),
        ("room2 help.json -o absent/help.svg", ["-o", "absent"]),
    ],
)
def test_what_is_wrong_is_said_in_one_line(command: str, words: list[str], run: Runs, tmp_path: Path) -> None:
    assert_one_line(run(f"show --example {command}"), *words)
    assert [path.name for path in tmp_path.iterdir()] == ["help.json"]
