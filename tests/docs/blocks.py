"""Fenced code blocks of the documentation, and how each is run."""

import contextlib
import io
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from serendipity.cli.app import main

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "README.md"
PAGES = sorted((ROOT / "docs").rglob("*.md"))
OTHERS = sorted([*ROOT.glob("*.md"), *ROOT.glob("*/DECISIONS.md")])
"""What is written beside the documentation, and links to it."""

_FENCE = re.compile(r"^``` *(?P<info>[^\n]*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
_SIMPLE = re.compile(r"(serendipity ([^\n$|<>;&*#]|\\\n)*\n)+")
"""Nothing but calls of the program: these run in this process, which is faster."""

_LINKED = re.compile(r"\]\(([\w/-]+\.pddl)\)")

_SKIPPED = "..."


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced block.

    Attributes:
        language: ``bash``, ``python``, ``pddl``, ``text`` or another.
        text: what it says.
        title: a file name, or empty.
        slow: whether it needs the authors' problems, and minutes.
    """

    language: str
    text: str
    title: str
    slow: bool


def path_of(page: Path) -> str:
    return str(page.relative_to(ROOT))


def blocks(page: Path) -> Iterator[Block]:
    """The blocks of a page, in order."""
    for found in _FENCE.finditer(page.read_text(encoding="utf-8")):
        info = found["info"]
        title = re.search(r'title="([^"]*)"', info)
        words = re.sub(r'[{}.]|title="[^"]*"', " ", info).split()
        yield Block(words[0] if words else "", found["text"], title[1] if title else "", "slow" in words)


def linked_files(page: Path) -> list[Path]:
    """The PDDL files to which a page links, which its readers save."""
    return [page.parent / link for link in _LINKED.findall(page.read_text(encoding="utf-8"))]


def prose(page: Path) -> str:
    """A page without its fenced blocks."""
    return re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)


def run(block: Block, folder: Path) -> str:
    """Run a block in a folder; what it prints.

    `make demo` is left out: it installs, and runs what is below it.

    Raises:
        AssertionError: it fails.
    """
    text = block.text.replace(".venv/bin/serendipity", "serendipity").replace("make demo\n", "")
    if block.language == "bash" and _SIMPLE.fullmatch(text):
        return _run_here(text, folder)
    if block.language == "bash":
        program = shlex.join([sys.executable, "-m", "serendipity"])
        testing = shlex.join([sys.executable, "-m", "pytest", "-p", "serendipity_testing.plugin"])
        functions = f'serendipity() {{ {program} "$@"; }}\npytest() {{ {testing} "$@"; }}\n'
        command = ["bash", "-c", f"set -e\nexport PYTEST_DISABLE_PLUGIN_AUTOLOAD=1\n{functions}{text}"]
    else:
        command = [sys.executable, "-c", text]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, (text, done.stdout, done.stderr)
    return done.stdout


def _run_here(text: str, folder: Path) -> str:
    printed = io.StringIO()
    for line in text.replace("\\\n", " ").splitlines():
        with contextlib.chdir(folder), contextlib.redirect_stdout(printed):
            code = main(shlex.split(line)[1:])
        assert code == 0, (line, printed.getvalue())
    return printed.getvalue()


def assert_shown(block: Block, printed: str) -> None:
    """Each line of a ``text`` block was printed, in that order; ``...`` stands for others."""
    lines = iter([line.rstrip() for line in printed.splitlines()])
    for line in block.text.splitlines():
        if line.strip() != _SKIPPED:
            assert line.rstrip() in lines, (line, printed)
