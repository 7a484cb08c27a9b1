"""Links between pages lead somewhere, all pages are in the navigation, all commands in the reference.

Pages name files and rooms that are there, all rooms are on the map, and prose can be read as a diff.
"""

import importlib.util
import re
from contextlib import nullcontext
from importlib import import_module
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

import serendipity
from serendipity.cli.on_demand import NAMES
from tests.docs.blocks import OTHERS, PAGES, ROOT, path_of, prose

READ = [*PAGES, *OTHERS]
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)


def anchor(heading: str) -> str:
    """The anchor that Markdown gives a heading."""
    return re.sub(r"[\s-]+", "-", re.sub(r"[^\w\s-]", "", heading.lower()).strip())


def test_anchors_are_those_of_markdown() -> None:
    assert anchor("3.2 Interruptibility report") == "32-interruptibility-report"
    assert anchor("3.1 Serendipity: windows") == "31-serendipity-windows"


@pytest.mark.parametrize("page", READ, ids=path_of)
def test_links_lead_somewhere(page: Path) -> None:
    for link in LINK.findall(prose(page)):
        if link.startswith(("https://", "http://")):
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
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("page", ["python", "execution", "testing"])
def test_the_reference_names_what_is_public(page: str) -> None:
    text = (ROOT / f"docs/reference/{page}.md").read_text(encoding="utf-8")
    for name in re.findall(r"^::: (.*)$", text, re.MULTILINE):
        module, _, attribute = name.rpartition(".")
        if module != "serendipity.up":  # an extra
            assert attribute in import_module(module).__all__, name


def test_all_public_names_are_in_the_reference() -> None:
    pages = [path.read_text(encoding="utf-8") for path in (ROOT / "docs/reference").glob("*.md")]
    listed = re.findall(r"^::: (.*)$", "\n".join(pages), re.MULTILINE)
    assert len(listed) == len(set(listed))
    rooms = ("serendipity.aio", "serendipity.execution", "serendipity.robot")
    for module in (*rooms, "serendipity_testing", "serendipity_testing.league"):
        assert {f"{module}.{name}" for name in import_module(module).__all__} <= {*listed}
    elsewhere = {name.rpartition(".")[2] for name in listed if name.startswith("serendipity.execution.")}
    assert {f"serendipity.{n}" for n in {*serendipity.__all__} - elsewhere - {"__version__"}} <= {*listed}


@pytest.mark.parametrize(
    ("page", "fetches"),
    [
        ('<script src="https://example.org/shim">', True),
        ('<link rel="stylesheet" href="https://example.org/a.css">', True),
        ('<img alt="" src="//example.org/a.png">', True),
        ('<script src="../javascripts/a.js"></script> <a href="https://example.org">there</a>', False),
    ],
)
def test_a_page_that_fetches_from_elsewhere_is_not_built(page: str, fetches: bool, hooks: ModuleType) -> None:
    file = SimpleNamespace(file=SimpleNamespace(src_uri="page.md"))
    with pytest.raises(RuntimeError, match="would fetch from elsewhere") if fetches else nullcontext():
        assert hooks.on_post_page(page, page=file) == page


def test_all_commands_are_in_the_reference(hooks: ModuleType) -> None:
    page = hooks.on_page_markdown((ROOT / "docs/reference/commands.md").read_text())
    shown = {heading.split()[0] for heading in re.findall(r"^## (.*)$", page, re.MULTILINE)}
    assert shown == {*NAMES}
    assert "--discount D" in page
    assert "<!--" not in page


WIDTH = 120
FILE = re.compile(r"`([\w.-]+(?:/[\w.-]+)*\.(?:py|c|h|md))`")
PACKAGES = ("serendipity", "search", "verify")
BESIDE = ("serendipity_live", "serendipity_testing", "serendipity_up")


@pytest.fixture(scope="module")
def files() -> list[str]:
    """Every file that a page may name."""
    folders = (*PACKAGES, *BESIDE, "tests", "benchmarks", "docs")
    paths = [*ROOT.glob("*.*"), *(path for folder in folders for path in (ROOT / folder).rglob("*.*"))]
    return [f"/{path.relative_to(ROOT)}" for path in paths]


@pytest.mark.parametrize("page", READ, ids=path_of)
def test_files_that_are_named_are_there(page: Path, files: list[str]) -> None:
    for named in FILE.findall(prose(page)):
        assert any(file.endswith(f"/{named}") for file in files), named


def test_the_map_names_every_room() -> None:
    text = prose(ROOT / "docs" / "design.md")
    for package in PACKAGES:
        for room in (path.parent.name for path in (ROOT / package).glob("*/__init__.py")):
            named = f"`{package}.{room}`" if package == "serendipity" else f"`{room}`"
            assert named in text, named


@pytest.mark.parametrize("page", READ, ids=path_of)
def test_prose_is_wrapped(page: Path) -> None:
    """Tables and code can't be."""
    for line in prose(page).splitlines():
        wide = len(line) > WIDTH and not line.lstrip().startswith(("|", "#", "!["))
        assert not wide, line
