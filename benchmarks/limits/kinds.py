"""A hundred tasks of all kinds: what limits on certificates are measured on.

20 of the published buildings, 10 that are generated, 32 of the multi-agent competition, 12 of the
published problems of silent assistance, 20 random ones, and the 6 that are shipped.
"""

from collections.abc import Iterator
from itertools import count, islice
from pathlib import Path
from typing import Final

import serendipity
from benchmarks.assistance import domain_of, problems
from benchmarks.limits.tasks import Named, tasks_of_suite
from serendipity.evaluation.crosscheck import random_call
from serendipity.pddl.write import write_pddl
from serendipity.scenarios.examples import EXAMPLES

_BUILDINGS: Final = (
    (21, 2, 1),
    (42, 2, 1),
    (42, 4, 2),
    (84, 2, 1),
    (84, 4, 3),
    (210, 2, 1),
    (210, 10, 1),
    (420, 2, 3),
    (840, 2, 1),
    (2100, 10, 1),
)
"""Rooms, medkits, robots."""


def tasks_of_all_kinds(problems_of_others: Path, scratch: Path) -> Iterator[Named]:
    """The hundred tasks, as far as the problems of others are there.

    Args:
        problems_of_others: the folder with ``usar200``, ``codmap15`` and ``spa``.
        scratch: where files go.
    """
    for number in range(1, 201, 10):
        yield _in_folder(f"usar {number}", problems_of_others / f"usar200/test{number}", robots=1)
    for rooms, medkits, robots in _BUILDINGS:
        folder = scratch / f"building{rooms}-{medkits}-{robots}"
        serendipity.generate_usar(folder, rooms=rooms, medkits=medkits, robots=robots)
        yield _in_folder(f"{rooms} rooms, {medkits} medkits, {robots} robots", folder, robots)
    yield from tasks_of_suite(problems_of_others / "codmap15", 3)
    for name, prime, supporter in islice(problems(problems_of_others / "spa"), 0, 72, 6):
        own, other = f"{domain_of(prime)},{prime}", f"{domain_of(supporter)},{supporter}"
        words = f"--agent prime={own} --agent supporter={other} --human prime"
        yield Named(f"spa {name}", {"task": words, "alone": words})
    yield from islice(_drawn(scratch), 20)
    for name, shipped in EXAMPLES.items():
        words = f"--example {name}"
        yield Named(name, {"task": words} | ({"alone": words} if len(shipped.robots) == 1 else {}))


def _drawn(scratch: Path) -> Iterator[Named]:
    """Random tasks whose goals the human may reach."""
    for seed in count():
        task = random_call(seed).task
        folder = scratch / f"drawn{seed}"
        write_pddl(task, folder)
        yield _in_folder(f"drawn {seed}", folder, len(task.robots), task.agents[task.human])


def _in_folder(name: str, folder: Path, robots: int, human: str | None = None) -> Named:
    words = str(folder) if human is None else f"{folder} --human {human}"
    return Named(name, {"task": words} | ({"alone": words} if robots == 1 else {}))
