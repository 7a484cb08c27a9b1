"""A call that has an answer soon, and no proof for minutes, on any machine."""

from pathlib import Path
from typing import Any, Final

import serendipity
from serendipity import Task

ENDLESS: Final[dict[str, Any]] = {"mode": "communication", "keep_prefix": True, "discount": 0.9}


def endless_task(folder: Path) -> Task:
    """What to ask for with these options."""
    serendipity.generate_usar(folder, rooms=200, medkits=3, robots=3, seed=1)
    return serendipity.load(folder)
