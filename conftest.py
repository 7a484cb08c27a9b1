"""Profiles of hypothesis, data that may be absent, a browser, and the running of commands.

``HYPOTHESIS_PROFILE=ci`` takes more examples, which are always the same, and ``fuzz`` many new ones.
"""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

import serendipity
from benchmarks.problems import PROBLEMS
from search.kernel.library import library
from serendipity import Task
from serendipity.cli.streams import progress_lines
from tests.cli.conftest import run as run  # a fixture of several rooms
from tests.show.browser import chromium, chromium_path

pytest_plugins = ["pytester"]

# Constants of our modules are not drawn: which ones are loaded depends on what a worker ran before, and so
# would the examples, which have to be the same each time.
providers._get_local_constants = lambda: providers._local_constants
_CALM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
settings.register_profile("quick", derandomize=True, max_examples=25, database=None, **_CALM)
settings.register_profile("ci", derandomize=True, max_examples=50, database=None, **_CALM)
settings.register_profile("dev", max_examples=50, **_CALM)
settings.register_profile("fuzz", max_examples=1000, print_blob=True, **_CALM)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))


def pytest_report_header() -> str:
    """Whether the tests run with the kernel."""
    return f"kernel: {'compiled' if library() else 'none'}"


@pytest.fixture(autouse=True, scope="session")
def _patience() -> Iterator[None]:
    """Commands say nothing of their progress, however busy the machine is; tests of it set their own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(progress_lines.PlainLines, "first", 3600.0)
        yield


def _data(name: str) -> Path:
    folder = PROBLEMS / name
    if not folder.is_dir():
        pytest.skip(f"needs the folder '{name}' in {PROBLEMS} (SERENDIPITY_PROBLEMS says where to look)")
    return folder


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """A headless Chromium."""
    pytest.importorskip("playwright.sync_api", reason="no playwright: `make test-browser` installs it")
    path = chromium_path()
    if path is None:
        pytest.skip("no chromium (CHROMIUM is its path): `make test-browser` installs it where it may")
    with chromium(path) as running:
        yield running


@pytest.fixture
def room2() -> Task:
    """The paper's example III-C."""
    return serendipity.example("room2")


@pytest.fixture(scope="session")
def usar200() -> Path:
    """The authors' 200 problems."""
    return _data("usar200")


@pytest.fixture(scope="session")
def ipc2002time() -> Path:
    """Domains of the planning competition of 2002, in time."""
    return _data("ipc2002time")


@pytest.fixture(scope="session")
def spa() -> Path:
    """The problems of silent proactive assistance."""
    return _data("spa")


@pytest.fixture(scope="session")
def codmap15() -> Path:
    """Domains of the multi-agent planning competition of 2015, in MA-PDDL."""
    return _data("codmap15")
