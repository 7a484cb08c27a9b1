"""``show`` writes the picture that the file's ending names, and says in one line what is wrong."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.conftest import Run, assert_one_line


@pytest.fixture
def answered(run: Callable[[str], Run], tmp_path: Path) -> Callable[[str], Run]:
    """Run command lines where ``help.json`` answers the example room2."""
    assert run("plan --example room2 --discount 0.6 -o help.json").code == 0
    return run


@pytest.mark.parametrize(
    ("ending", "start"), [("html", b"<!doctype html>"), ("svg", b"<svg"), ("png", b"\x89PNG")]
)
def test_the_ending_chooses_the_form(
    ending: str, start: bytes, answered: Callable[[str], Run], tmp_path: Path
) -> None:
    if ending == "png":
        pytest.importorskip("matplotlib", reason="needs the extra 'plot'")
    done = answered(f"show --example room2 help.json -o help.{ending}")
    assert (done.code, done.out, done.err) == (0, "", "")
    assert (tmp_path / f"help.{ending}").read_bytes().startswith(start)


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("show --example room2 help.json", ["-o", ".html"]),
        ("show --example room2 help.json -o help.gif", ["-o", "help.gif"]),
        ("show --example room2 help.json -o help.html --epoch 3", ["--epoch"]),
        ("show --example room2 help.json -o help.svg --epoch 99", ["epoch", "99"]),
        ("show --example room7 help.json -o help.svg", ["help.json", "not applicable"]),
        ("show --example room2 absent.json -o help.svg", ["absent.json"]),
        ("show --example room2 help.json -o absent/help.svg", ["-o", "absent"]),
    ],
)
def test_what_is_wrong_is_said_in_one_line(
    command: str, words: list[str], answered: Callable[[str], Run], tmp_path: Path
) -> None:
    assert_one_line(answered(command), *words)
    assert [path.name for path in tmp_path.iterdir()] == ["help.json"]
