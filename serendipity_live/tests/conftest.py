from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from serendipity.cli.app import main
from serendipity_live.tests.server import Server, serving
from serendipity_live.tests.studies import PLAIN
from tests.facade.conftest import ENDLESS

Opened = Callable[..., Any]


@pytest.fixture(scope="package")
def server() -> Iterator[Server]:
    """One service for all tests that leave it as they found it."""
    with serving("--workers", "2", "--queue", "8", "--body-limit", "0.5", "--time-limit", "20") as started:
        yield started


@pytest.fixture(scope="module")
def long_call(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """A call that has an answer soon, and no proof for minutes."""
    folder = tmp_path_factory.mktemp("long") / "building"
    words = "--rooms 200 --medkits 3 --robots 3 --seed 1 --layout pair"
    assert main(["generate", "usar", *words.split(), "-o", str(folder)]) == 0
    texts = {name: (folder / f"{name}.pddl").read_text() for name in ("domain", "problem")}
    task = {**texts, "human": "commx", "robots": ["robot1", "robot2", "robot3"]}
    return {"task": task, "options": ENDLESS}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Of a study of two scenarios of its own, which are there at once."""
    (tmp_path / "study.toml").write_text(PLAIN)
    return tmp_path


@pytest.fixture
def opened(browser: Any) -> Iterator[Opened]:
    """Open a page; nobody may complain on its console, nor ask for anything of elsewhere."""
    complaints: list[str] = []
    pages = []

    def opens(server: Server, width: int = 1440, height: int = 900, at: str = "") -> Any:
        def elsewhere(url: str) -> list[str]:
            return [] if server.url[7:] in url or url.startswith("data:") else [url]

        page = browser.new_page(viewport={"width": width, "height": height})
        page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("request", lambda asked: complaints.extend(elsewhere(asked.url)))
        page.goto(server.url + at)
        pages.append(page)
        return page

    yield opens
    for page in pages:
        page.close()
    assert [c for c in complaints if "ERR_CONNECTION_REFUSED" not in c and "/live" not in c] == []
