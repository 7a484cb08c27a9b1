"""Pages name files and rooms that are there, all rooms are on the map, and prose can be read as a diff."""

import re
from pathlib import Path

import pytest

from tests.docs.blocks import OTHERS, PAGES, ROOT, prose

WIDTH = 120
FILE = re.compile(r"`([\w.-]+(?:/[\w.-]+)*\.(?:py|c|h|md))`")
PACKAGES = ("serendipity", "search", "verify")
READ = [*PAGES, *OTHERS]


def name(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.fixture(scope="module")
def files() -> list[str]:
    """Every file that a page may name."""
    folders = (*PACKAGES, "tests", "benchmarks", "docs")
    paths = [*ROOT.glob("*.*"), *(path for folder in folders for path in (ROOT / folder).rglob("*.*"))]
    return [f"/{path.relative_to(ROOT)}" for path in paths]


@pytest.mark.parametrize("page", READ, ids=name)
def test_files_that_are_named_are_there(page: Path, files: list[str]) -> None:
    for named in FILE.findall(prose(page)):
        assert any(file.endswith(f"/{named}") for file in files), named


def test_the_map_names_every_room() -> None:
    text = prose(ROOT / "docs" / "design.md")
    for package in PACKAGES:
        for room in (path.parent.name for path in (ROOT / package).glob("*/__init__.py")):
            named = f"`{package}.{room}`" if package == "serendipity" else f"`{room}`"
            assert named in text, named


@pytest.mark.parametrize("page", READ, ids=name)
def test_prose_is_wrapped(page: Path) -> None:
    """Tables and code can't be."""
    for line in prose(page).splitlines():
        wide = len(line) > WIDTH and not line.lstrip().startswith(("|", "#", "!["))
        assert not wide, line
