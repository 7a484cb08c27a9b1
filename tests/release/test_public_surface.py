"""What is public is there, and is written down: a change to it shows in the commit that makes it.

Type checkers see what is wrong with a user's program, and find nothing wrong with the rest of it.
"""

import json
import re
import shutil
import subprocess
import sys
from difflib import unified_diff
from importlib.util import find_spec
from pathlib import Path

import pytest

import serendipity
from tests.release.surface import WRITTEN, surface

RENEW = "The public surface is another one (docs/reference/stability.md): `python -m tests.release.surface`"


@pytest.mark.skipif(find_spec("unified_planning") is None, reason="the extra `up` is not installed")
def test_the_public_surface_is_the_one_that_is_written_down() -> None:
    before, after = WRITTEN.read_text(encoding="utf-8").splitlines(), surface().splitlines()
    differing = unified_diff(before, after, "written", "now", lineterm="", n=0)
    assert before == after, "\n".join([RENEW, *differing])


ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("name", serendipity.__all__)
def test_every_public_name_loads(name: str) -> None:
    assert getattr(serendipity, name) is not None
    assert name in dir(serendipity)


def test_other_names_are_attribute_errors() -> None:
    with pytest.raises(AttributeError, match="'plans'"):
        serendipity.plans  # noqa: B018


@pytest.mark.parametrize("package", ["serendipity", "search", "verify"])
def test_annotations_are_for_others_too(package: str) -> None:
    assert (ROOT / package / "py.typed").exists()


PROGRAM = Path(__file__).parent / "user_program.py"
WRONG = {
    number
    for number, line in enumerate(PROGRAM.read_text(encoding="utf-8").splitlines(), start=1)
    if re.search(r"# type: ignore\[", line)
}


@pytest.mark.slow  # in quick runs tests/model/test_options_are_typed.py holds options to their types
def test_mypy_sees_what_is_wrong(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", f"--cache-dir={tmp_path}", PROGRAM]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stdout  # strict: a mark on a line that is right is an error, too


@pytest.mark.skipif(shutil.which("pyright") is None, reason="pyright is not installed")
def test_pyright_sees_what_is_wrong(tmp_path: Path) -> None:
    shutil.copy(PROGRAM, tmp_path)
    settings = {"typeCheckingMode": "strict", "enableTypeIgnoreComments": False}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
    command = ["pyright", "--outputjson", "--pythonpath", sys.executable, "-p", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = json.loads(done.stdout)["generalDiagnostics"]
    assert {each["range"]["start"]["line"] + 1 for each in found} == WRONG, found
