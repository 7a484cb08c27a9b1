"""Scenarios of a study: seeded tasks in the paper's building in which help pays."""

from fractions import Fraction
from tempfile import TemporaryDirectory
from typing import Final

import serendipity
from serendipity.model import Task, UsageError

_TRIES: Final = 200
"""Seeds that are looked at for each scenario."""


def scenarios(count: int, seed: int, discount: Fraction) -> list[tuple[str, Task]]:
    """Tasks with their names.

    Args:
        count: how many.
        seed: the first seed that is looked at; each task is of one seed.
        discount: of robots' costs.

    Raises:
        UsageError: help pays in too few.
    """
    found = []
    for number in range(seed, seed + _TRIES * count):
        task = _task(number)
        result = serendipity.plan(task, discount=discount, human_model="observant")
        if result.opportunity:
            found.append((f"figure2-{number}", task))
        if len(found) == count:
            return found
    raise UsageError(f"--discount: at {float(discount):g} help pays in too few scenarios")


def _task(seed: int) -> Task:
    with TemporaryDirectory(prefix="serendipity-") as folder:
        serendipity.generate_usar(folder, preset="figure2", seed=seed)
        return serendipity.load(folder, human="commx")
