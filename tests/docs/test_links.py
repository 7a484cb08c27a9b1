"""Links between pages lead somewhere, all pages are in the navigation, all commands in the reference."""

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

import serendipity
import serendipity.testing
from serendipity.cli.on_demand import NAMES
from tests.docs.blocks import PAGES, ROOT

LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)


def anchor(heading: str) -> str:
    """The anchor that Markdown gives a heading."""
    return re.sub(r"[\s-]+", "-", re.sub(r"[^\w\s-]", "", heading.lower()).strip())


def test_anchors_are_those_of_markdown() -> None:
    assert anchor("3.2 Interruptibility report") == "32-interruptibility-report"
    assert anchor("3.1 Serendipity: windows") == "31-serendipity-windows"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    for link in LINK.findall(text):
        if link.startswith("https://"):
            continue
        path, _, fragment = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.is_file(), link
        if fragment:
            assert fragment in {anchor(heading) for heading in HEADING.findall(target.read_text())}, link


def test_all_pages_are_in_the_navigation() -> None:
    listed = set(re.findall(r"[\w/-]+\.md", (ROOT / "mkdocs.yml").read_text()))
    assert listed == {str(page.relative_to(ROOT / "docs")) for page in PAGES}


@pytest.fixture(scope="module")
def hooks() -> ModuleType:
    spec = importlib.util.spec_from_file_location("hooks", ROOT / "docs" / "hooks.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_all_public_names_are_in_the_reference(hooks: ModuleType) -> None:
    page = hooks.on_page_markdown((ROOT / "docs/reference/python.md").read_text())
    headings = re.findall(r"^### (\w+)$", page, re.MULTILINE)
    assert sorted(headings) == sorted(set(serendipity.__all__) - {"__version__"})
    assert "<!--" not in page
    assert "Raises:" in page


def test_all_names_of_the_testing_kit_are_in_the_reference(hooks: ModuleType) -> None:
    page = hooks.on_page_markdown((ROOT / "docs/reference/testing.md").read_text())
    assert re.findall(r"^### (\w+)$", page, re.MULTILINE) == serendipity.testing.__all__
    assert "<!--" not in page
    assert "Raises:" in page


def test_all_commands_are_in_the_reference(hooks: ModuleType) -> None:
    page = hooks.on_page_markdown((ROOT / "docs/reference/commands.md").read_text())
    shown = {heading.split()[0] for heading in re.findall(r"^## (.*)$", page, re.MULTILINE)}
    assert shown == {*NAMES}
    assert "--discount D" in page
    assert "<!--" not in page
