"""A call that has an answer soon, and no proof for minutes, on any machine."""

from typing import Any, Final

import pytest

import serendipity
from serendipity import Task

ENDLESS: Final[dict[str, Any]] = {"mode": "communication", "keep_prefix": True, "discount": 0.9}


@pytest.fixture(scope="module")
def endless(tmp_path_factory: pytest.TempPathFactory) -> Task:
    """What to ask for with these options."""
    folder = tmp_path_factory.mktemp("building")
    serendipity.generate_usar(folder, rooms=200, medkits=3, robots=3, seed=1)
    return serendipity.load(folder)
