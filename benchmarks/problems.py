"""The problems of others, which are not part of this repository; and tasks that processes can be told."""

import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import typer

import serendipity
from serendipity import SerendipityError, Task
from serendipity.evaluation.measuring.suites import Roles, SuiteProblem, folders, problems, roles
from serendipity.evaluation.measuring.tables import grouped
from serendipity.model import Condition
from serendipity.pictures.map.names import natural
from serendipity_testing.generator import FAMILIES, family_task

PROBLEMS = Path(os.environ.get("SERENDIPITY_PROBLEMS") or Path(__file__).resolve().parents[2] / "shared")
"""The folder with ``usar200``, ``codmap15``, ``spa`` and ``home``, as far as they are there.

``SERENDIPITY_PROBLEMS`` names it; without, it is ``../shared``, beside the checkout.
"""

Record = Annotated[
    Path | None, typer.Option(help="Write results here as they come; what is there is not asked again.")
]

Pair = tuple[Path, Path]
"""A domain and a problem file."""

Source = tuple[Any, ...]
"""A task by what makes it: rooms, medkits, robots and seed of a building; family, seed, size and agents of a
random one; a folder and who is the human; or domain and problem files, human and robots.
"""


def run(main: Callable[..., None], about: str | None) -> None:
    """Call a benchmark as the command line has it; its help is what its module says."""
    main.__doc__ = about
    typer.run(main)


def load(source: Source) -> Task:
    """The task of a source."""
    if isinstance(source[0], int):
        return building(*source)
    if source[0] in FAMILIES:
        return family_task(*source)
    if len(source) == 2:
        return serendipity.load(source[0], human=source[1])
    domain, problem, human, *robots = source
    return serendipity.load_pddl(domain, problem, human, robots)


def building(rooms: int, medkits: int, robots: int, seed: int) -> Task:
    """A generated building as a task."""
    with TemporaryDirectory() as folder:
        serendipity.generate_usar(folder, rooms=rooms, medkits=medkits, robots=robots, seed=seed)
        return serendipity.load(folder)


def usar(stride: int = 1) -> list[Source]:
    """Every so many of the 200 buildings; none where they are not there."""
    suite = PROBLEMS / "usar200"
    return [(str(folder), "commx") for folder in folders(suite, stride)] if suite.is_dir() else []


def of_suite(
    suite: Path, able: Callable[[SuiteProblem, Roles], bool], *, stride: int = 1, smallest: int | None = None
) -> Iterator[tuple[SuiteProblem, Roles, Source]]:
    """Problems of a suite, with the human, who is ``able`` alone, and two robots; none where it is not there.

    Of each domain every so many, or only so many of the smallest.
    """
    found = problems(suite, stride=stride) if suite.is_dir() else []
    for of in grouped(found, lambda problem: problem.domain).values():
        ordered = sorted(of, key=lambda problem: (len(problem.name), problem.name)) if smallest else of
        for problem in ordered[:smallest]:
            who = roles(problem, 2, able)
            files = (str(problem.domain_file), str(problem.problem_file))
            yield problem, who, (*files, who.human, *who.robots)


def can_alone(problem: SuiteProblem, who: Roles) -> bool:
    """True if a human is found to have a plan alone, in three seconds."""
    return _decides(lambda: problem.task(who), 3)


def can_some(problem: SuiteProblem, who: Roles) -> bool:
    """True if a human is found to reach two of the goals alone."""

    def with_two_goals() -> Task:
        task = problem.task(who)
        wanted = Random(f"{problem.domain} {problem.name} 0").sample(task.goal.positive, 2)
        return task.with_goal(Condition(tuple(sorted(wanted)), ()))

    return _decides(with_two_goals, 60)


def _decides(make: Callable[[], Task], seconds: float) -> bool:
    try:
        return serendipity.plan(make(), mode="individual", time_limit=seconds).cost is not None
    except (SerendipityError, ValueError):
        return False


def silent(folder: Path = PROBLEMS / "spa") -> Iterator[tuple[str, Pair, Pair]]:
    """The published problems of silent assistance: name, files of the human, *prime*, and the supporter."""
    found = folder.glob("*/*_problem_*_prime.pddl")
    for prime in sorted(found, key=lambda path: (path.parent.name, natural(path.name))):
        supporter = prime.with_name(prime.name.replace("_prime", "_supporter"))
        (number,) = re.findall(r"problem_(\d+)", prime.name)
        yield f"{prime.parent.name}/{number}", (_domain(prime), prime), (_domain(supporter), supporter)


def silent_task(prime: Pair, supporter: Pair) -> Task:
    """The task of such a problem."""
    return serendipity.load_agents({"prime": prime, "supporter": supporter}, human="prime")


def _domain(problem: Path) -> Path:
    return problem.with_name(re.sub(r"problem_\d+", "domain", problem.name))
