"""Running command lines: in this process (fast), or in one of their own (real)."""

import json
import shlex
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from serendipity.cli.app import main

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True, slots=True)
class Run:
    """What a command line did."""

    code: int
    out: str
    err: str


Runs = Callable[[str], Run]
"""What runs a command line, given without the program's name."""


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Runs:
    """Run a command line (without the program's name) in an empty folder, in this process."""
    monkeypatch.chdir(tmp_path)

    def runs(command: str) -> Run:
        code = main(shlex.split(command))
        captured = capsys.readouterr()
        return Run(code, captured.out, captured.err)

    return runs


@pytest.fixture
def answer(run: Runs) -> dict[str, Any]:
    """A good result of the example room2, which ``help.json`` in the working folder says."""
    assert run("plan --example room2 --discount 0.6 -o help.json").code == 0
    read: dict[str, Any] = json.loads(Path("help.json").read_text())
    return read


@pytest.fixture
def process(tmp_path: Path) -> Runs:
    """Run a command line in an empty folder, as a process of its own."""

    def runs(command: str) -> Run:
        done = subprocess.run(
            [sys.executable, "-m", "serendipity", *shlex.split(command)],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
        return Run(done.returncode, done.stdout, done.stderr)

    return runs


def assert_one_line(run: Run, *words: str) -> None:
    """Exit 2, nothing on stdout, one line on stderr with these words in it."""
    assert run.code == 2, run
    assert run.out == ""
    assert run.err.startswith("Error: "), run.err
    assert run.err.endswith("\n")
    assert run.err.count("\n") == 1, run.err
    for word in words:
        assert word in run.err
