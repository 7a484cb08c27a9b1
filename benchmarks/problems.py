"""The problems of others, which are not part of this repository."""

import os
import re
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import serendipity
from serendipity import SerendipityError, Task
from serendipity.evaluation.measuring.suites import Problem, Roles

PROBLEMS = Path(os.environ.get("SERENDIPITY_PROBLEMS") or Path(__file__).resolve().parents[2] / "shared")
"""The folder with ``usar200``, ``codmap15`` and ``spa``, as far as they are there.

``SERENDIPITY_PROBLEMS`` names it; without, it is ``../shared``, beside the checkout.
"""

Pair = tuple[Path, Path]
"""A domain and a problem file."""


def silent(folder: Path = PROBLEMS / "spa") -> Iterator[tuple[str, Pair, Pair]]:
    """The published problems of silent assistance: name, files of the human, *prime*, and the supporter."""
    found = list(folder.glob("*/*_problem_*_prime.pddl"))
    for prime in sorted(found, key=lambda path: (path.parent.name, _number(path))):
        supporter = prime.with_name(prime.name.replace("_prime", "_supporter"))
        yield (
            f"{prime.parent.name}/{_number(prime)}",
            (_domain(prime), prime),
            (_domain(supporter), supporter),
        )


def silent_task(prime: Pair, supporter: Pair) -> Task:
    """The task of such a problem."""
    return serendipity.load_agents({"prime": prime, "supporter": supporter}, human="prime")


def building(rooms: int, medkits: int, robots: int, seed: int) -> Task:
    """A generated building as a task."""
    with TemporaryDirectory() as folder:
        serendipity.generate_usar(folder, rooms=rooms, medkits=medkits, robots=robots, seed=seed)
        return serendipity.load(folder)


def can_alone(problem: Problem, who: Roles) -> bool:
    """True if a human is found to have a plan alone, in three seconds."""
    try:
        return serendipity.plan(problem.task(who), mode="individual", time_limit=3).cost is not None
    except SerendipityError:
        return False


def _number(problem: Path) -> int:
    return int(re.findall(r"problem_(\d+)", problem.name)[0])


def _domain(problem: Path) -> Path:
    return problem.with_name(re.sub(r"problem_\d+", "domain", problem.name))
