"""Every block of the README runs as it stands, in order, in one folder."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import ROOT

BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", (ROOT / "README.md").read_text(encoding="utf-8"), re.M | re.S)


def test_the_readme_opens_with_the_two_commands() -> None:
    language, text = BLOCKS[0]
    commands = text.splitlines()
    assert language == "bash"
    assert commands[0] == "make demo"
    assert commands[1].endswith("serendipity plan --example room2 --discount 0.6")
    demo = next(line for line in (ROOT / "Makefile").read_text().splitlines() if "serendipity plan" in line)
    assert demo.split("serendipity ")[1] == commands[1].split("serendipity ")[1]


def test_blocks_run(tmp_path: Path) -> None:
    """`make demo` is left out: it runs the command below it, after an installation."""
    program = shlex.join([sys.executable, "-m", "serendipity"])
    ran = 0
    for language, text in BLOCKS:
        if language == "bash":
            lines = text.replace(".venv/bin/serendipity", "serendipity").replace("make demo\n", "")
            script = f'set -e\nserendipity() {{ {program} "$@"; }}\n{lines}'
            command = ["bash", "-c", script]
        elif language == "python":
            command = [sys.executable, "-c", text]
        else:
            pytest.fail(f"a block of the README is not run: {language}")
        done = subprocess.run(
            command,
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, (text, done.stdout, done.stderr)
        assert done.stdout
        ran += 1
    assert ran == len(BLOCKS) >= 4
