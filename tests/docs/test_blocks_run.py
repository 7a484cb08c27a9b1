"""Every code block of the documentation runs, page by page in one folder, and prints what is shown.

So do the notebooks, from the top.
"""

import ast
import contextlib
import io
import json
import shutil
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from tests.docs.blocks import PAGES, README, ROOT, Block, assert_shown, blocks, linked_files, path_of, run

RUN = ("bash", "python")
SHOWN = ("pddl", "text")


def pages_with(*, slow: bool) -> list[Path]:
    return [
        page for page in (README, *PAGES) if any(b.language in RUN and b.slow == slow for b in blocks(page))
    ]


@pytest.mark.long
@pytest.mark.parametrize("page", pages_with(slow=False), ids=path_of)
def test_blocks_run(page: Path, tmp_path: Path) -> None:
    printed: str | None = None
    for file in linked_files(page):
        shutil.copy(file, tmp_path)
    for block in blocks(page):
        if block.language in RUN and not block.slow:
            printed = run(block, tmp_path)
        elif block.language == "text" and printed is not None:
            assert_shown(block, printed)
            printed = None
        elif block.title:
            (tmp_path / block.title).write_text(block.text)


@pytest.mark.slow
@pytest.mark.parametrize("page", pages_with(slow=True), ids=path_of)
def test_slow_blocks_run(page: Path, usar200: Path, codmap15: Path, tmp_path: Path) -> None:
    (tmp_path / "usar200").symlink_to(usar200)
    (tmp_path / "codmap15").symlink_to(codmap15)
    (tmp_path / "benchmarks").symlink_to(ROOT / "benchmarks")
    for block in blocks(page):
        if block.slow:
            run(block, tmp_path)


@pytest.mark.parametrize("page", [README, *PAGES], ids=path_of)
def test_every_block_is_of_a_known_kind(page: Path) -> None:
    for block in blocks(page):
        assert block.language in (*RUN, *SHOWN), block


def test_the_readme_opens_with_the_two_commands() -> None:
    first, *more = blocks(README)
    commands = first.text.splitlines()
    assert first.language == "bash" and len(more) >= 3
    assert commands[0] == "make demo"
    assert commands[1].endswith("serendipity plan --example room2 --discount 0.6")
    demo = next(line for line in (ROOT / "Makefile").read_text().splitlines() if "serendipity plan" in line)
    assert demo.split("serendipity ")[1] == commands[1].split("serendipity ")[1]


def test_a_line_that_was_not_printed_is_noticed() -> None:
    shown = Block("text", "a\n...\nc\n", "", slow=False)
    assert_shown(shown, "a\nb\nc\n")
    for printed in ("a\nb\n", "c\na\n"):
        with pytest.raises(AssertionError):
            assert_shown(shown, printed)


NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


NEEDS = {"unified-planning": ("unified_planning", "up_fast_downward", "up_symk")}
"""What a notebook imports that need not be installed."""


def test_there_are_four() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["own-domain", "paper", "study", "unified-planning"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_cells_print_what_is_shown(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(path.parent)
    absent = [name for name in NEEDS.get(path.stem, ()) if find_spec(name) is None]
    if absent:
        pytest.skip(f"needs {', '.join(absent)}")
    names: dict[str, Any] = {}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] != "code":
            continue
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            value = _executed("".join(cell["source"]), names)
        shown = "".join("".join(out["text"]) for out in cell["outputs"] if out["output_type"] == "stream")
        assert printed.getvalue() == shown
        results = [out["data"] for out in cell["outputs"] if out["output_type"] == "execute_result"]
        assert results == [] if value is None else [repr(value)] == results[0]["text/plain"]


def _executed(source: str, names: dict[str, Any]) -> object:
    """The value of a cell's last line, where that is an expression."""
    body = ast.parse(source).body
    last = body.pop() if isinstance(body[-1], ast.Expr) else None
    exec(compile(ast.Module(body, []), source, "exec"), names)
    return None if last is None else eval(compile(ast.Expression(last.value), source, "eval"), names)
