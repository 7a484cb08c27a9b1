"""What is released can be built, tested and cited: nothing that is tracked stays behind."""

import re
import subprocess
import sys
import tarfile
from importlib import import_module
from pathlib import Path

import pytest

from serendipity import __version__

ROOT = Path(__file__).resolve().parents[2]


def test_the_sources_have_all_that_is_tracked(tmp_path: Path) -> None:
    if not (ROOT / ".git").exists():
        pytest.skip("these are released sources: nothing here says what is tracked")
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    command = [sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as sources:
        names = {name.partition("/")[2] for name in sources.getnames()}
    assert set(tracked.stdout.splitlines()) <= names


def test_the_citation_is_of_this_version() -> None:
    assert f"\nversion: {__version__}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_what_runs_is_installed_as_developers_have_it() -> None:
    pins = {
        name: set(re.findall(r"^[\w.-]+==[^ ;\\]+", (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE))
        for name in ("requirements.txt", "requirements-dev.txt")
    }
    assert pins["requirements.txt"] <= pins["requirements-dev.txt"]


def test_the_makefile_imports_what_is_there() -> None:
    """`make bench` asked a module that had moved, and installed Fast Downward each time."""
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    found = re.findall(r"from (serendipity[\w.]*) import (\w+)", makefile)
    assert found and all(hasattr(import_module(module), name) for module, name in found)
