"""A small suite of tasks, some with an opportunity."""

from pathlib import Path

import pytest

import serendipity

PRESETS = ("room2", "room7", "room5", "room2", "room7", "room5")


@pytest.fixture(scope="session")
def suite(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """``test1`` to ``test6``: the paper's examples, twice."""
    folder = tmp_path_factory.mktemp("suite")
    for number, preset in enumerate(PRESETS, start=1):
        serendipity.generate_usar(folder / f"test{number}", preset=preset)
    return folder
