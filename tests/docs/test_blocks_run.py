"""Every code block of the documentation runs, page by page in one folder, and prints what is shown."""

import shutil
from pathlib import Path

import pytest

from tests.docs.blocks import PAGES, README, ROOT, Block, assert_shown, blocks, linked_files, run

RUN = ("bash", "python")
SHOWN = ("pddl", "text")


def pages_with(*, slow: bool) -> list[Path]:
    return [
        page for page in (README, *PAGES) if any(b.language in RUN and b.slow == slow for b in blocks(page))
    ]


def name(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.mark.long
@pytest.mark.parametrize("page", pages_with(slow=False), ids=name)
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
@pytest.mark.parametrize("page", pages_with(slow=True), ids=name)
def test_slow_blocks_run(page: Path, usar200: Path, codmap15: Path, tmp_path: Path) -> None:
    (tmp_path / "usar200").symlink_to(usar200)
    (tmp_path / "codmap15").symlink_to(codmap15)
    (tmp_path / "benchmarks").symlink_to(ROOT / "benchmarks")
    for block in blocks(page):
        if block.slow:
            run(block, tmp_path)


@pytest.mark.parametrize("page", [README, *PAGES], ids=name)
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
