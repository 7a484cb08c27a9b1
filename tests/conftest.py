"""Profiles of hypothesis, warnings as errors, the marker ``slow``, data that may be absent."""

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

SHARED = Path(__file__).resolve().parents[2] / "shared"

_CALM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
settings.register_profile("ci", derandomize=True, max_examples=150, database=None, **_CALM)
settings.register_profile("dev", max_examples=50, **_CALM)
settings.register_profile("fuzz", max_examples=3000, print_blob=True, **_CALM)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--slow", action="store_true", help="run the tests marked slow too")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "slow: takes more than a few seconds; runs with --slow")
    config.addinivalue_line("filterwarnings", "error")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("--slow"):
        return
    skip = pytest.mark.skip(reason="slow; run with --slow")
    for item in items:
        if "slow" in item.keywords:
            item.add_marker(skip)


def _data(name: str) -> Path:
    folder = SHARED / name
    if not folder.is_dir():
        pytest.skip(f"needs the data folder '{name}' beside the repository")
    return folder


@pytest.fixture(scope="session")
def usar200() -> Path:
    """The authors' 200 problems."""
    return _data("usar200")


@pytest.fixture(scope="session")
def spa() -> Path:
    """The problems of silent proactive assistance."""
    return _data("spa")
