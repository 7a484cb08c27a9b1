"""What the bridge to unified-planning comes to: the library's own report, and tasks there and back.

    python -m benchmarks.up_bridge report CHECKOUT [--packages "P ..."] [--timeout S]
    python -m benchmarks.up_bridge random [--count N]
    python -m benchmarks.up_bridge suite [FOLDER] [--time-limit S] [--stride N]
    python -m benchmarks.up_bridge files CHECKOUT

``report`` runs ``up_test_cases/report.py`` of a checkout of unified-planning (of the version that is
installed; its wheel lacks the problems in PDDL) for the engine ``serendipity``, and counts what it says.
``random`` and ``suite`` compare optima of tasks read as PDDL with those of the same tasks written as
problems of the library and read again, ``suite`` also the tasks themselves; ``files`` compares optima of
its teams with those of the MA-PDDL that its writer makes of them, factored and unfactored.
"""

import importlib
import re
import subprocess
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

import serendipity
from benchmarks.problems import PROBLEMS
from serendipity import Result, SerendipityError, Task
from serendipity.evaluation.crosscheck import random_call
from serendipity.evaluation.measuring.suites import problems
from serendipity.pddl import read_pddl
from serendipity.pddl.write import write_pddl
from serendipity.up import from_problem, to_plan, to_problem
from serendipity.up.engine import SerendipityEngine
from serendipity.up.names import legal

TEAM: dict[str, Any] = {"mode": "composite", "horizon": "inf", "interference": "strict"}
ALONE: dict[str, Any] = {"mode": "individual"}
HELP: dict[str, Any] = {"mode": "serendipity", "discount": "3/5"}

_REPORT = """
import runpy, sys
sys.path.insert(0, "up_test_cases")
import serendipity.up
sys.argv = ["up_test_cases/report.py", "serendipity", *sys.argv[1:]]
runpy.run_path(sys.argv[0], run_name="__main__")
"""
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_TIMES = re.compile(r"\b[0-9.]+s\b( \([0-9.]+s\))?")


def main(
    what: Literal["report", "random", "suite", "files"],
    folder: Annotated[Path | None, typer.Argument()] = None,
    packages: str = "",
    timeout: float = 10,
    count: int = 200,
    time_limit: float = 3,
    stride: int = 1,
) -> None:
    """Print what was asked for; a time limit of 0 compares tasks only."""
    if what == "random":
        told(random(count))
    elif what == "suite":
        told(suite(folder or PROBLEMS / "codmap15", time_limit, stride))
    elif folder is None:
        raise typer.BadParameter(f"expected a checkout of unified-planning behind {what}")
    elif what == "report":
        report(folder, packages.split(), timeout)
    else:
        told(files(folder))


def report(checkout: Path, packages: list[str], timeout: float) -> None:
    """The library's report: how often it says what, and what it complains of."""
    chosen = ["-p", *packages] if packages else []
    command = [sys.executable, "-c", _REPORT, "-t", str(timeout), *chosen]
    done = subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=False)
    if not done.stdout:
        sys.exit(done.stderr)
    mode, seen = "", Counter[str]()
    for line in _COLOUR.sub("", done.stdout).splitlines():
        if line.isupper() and not line.startswith(" "):
            mode = line.strip(":").lower()
        elif line.startswith("|"):
            seen[f"{mode}: {' '.join(_TIMES.sub('', line).split()[2:])}"] += 1
        elif "errors:" in line:
            print(line)
    for what, number in seen.items():
        print(f"{number:5} {what}")
    print("exit code", done.returncode)


def told(found: Iterator[tuple[str, str]]) -> None:
    """Print differences as they come, and in the end how many there are of each outcome."""
    seen = Counter[str]()
    for name, outcome in found:
        seen[outcome] += 1
        if "differ" in outcome or "refused" in outcome or "invalid" in outcome:
            print(f"{name}: {outcome}", flush=True)
    for outcome, number in sorted(seen.items()):
        print(f"{number:5} {outcome}")


def random(count: int) -> Iterator[tuple[str, str]]:
    """Random tasks, through PDDL and through the library."""
    for seed in range(count):
        task = random_call(seed).task
        with tempfile.TemporaryDirectory() as folder:
            write_pddl(task, folder)
            first = serendipity.load(folder, human=task.agents[task.human])
        yield from through(f"seed {seed}", first, task, [TEAM] if task.robot_goal else [TEAM, ALONE, HELP])


def suite(folder: Path, seconds: float, stride: int) -> Iterator[tuple[str, str]]:
    """Problems of a suite in MA-PDDL, read as they are, and through the library."""
    for problem in problems(folder, stride=stride):
        unit = problem.unit()
        kinds = {schema.parameters[0].type for schema in unit.domain.schemas if schema.agent}
        human = min(name for kind in kinds for name in unit.objects_of(kind))
        task = read_pddl(problem.domain_file, problem.problem_file, human)
        limited = [{**options, "time_limit": seconds} for options in (TEAM, ALONE)]
        name = f"{problem.domain}/{problem.name}"
        who: dict[str, Any] = {"human": human, "robots": [task.agents[i] for i in task.robots]}
        same = content(task) == content(from_problem(to_problem(task), **who))
        yield name, "task: same" if same else "task: differ"
        if seconds:
            yield from through(name, task, task, limited)


def through(name: str, first: Task, task: Task, calls: list[dict[str, Any]]) -> Iterator[tuple[str, str]]:
    """A task beside itself as it comes back from the library."""
    who: dict[str, Any] = {"human": task.agents[task.human], "robots": [task.agents[i] for i in task.robots]}
    problem = to_problem(task)
    second = from_problem(problem, **who)
    for options in calls:
        before, after = serendipity.plan(first, **options), serendipity.plan(second, **options)
        yield name, f"{options['mode']}: {compared(before, after)}"
        if options["mode"] == "composite" and after.plan is not None:
            valid = SerendipityEngine(**who).validate(problem, to_plan(after, problem))
            yield name, f"plan in the library: {'valid' if valid else 'invalid'}"


def content(task: Task) -> tuple[object, ...]:
    """What a task is about, by agents' and facts' names: its optima follow from it.

    Facts that no action can change are left out, and so are effects that change nothing.
    """
    added = {fact for action in task.actions for fact in action.add}
    deleted = {fact for action in task.actions for fact in action.delete}
    always, never = task.init - deleted, frozenset(range(len(task.facts))) - task.init - added
    words = {fact: legal(name) for fact, name in enumerate(task.facts) if fact not in always | never}
    assert len(set(words.values())) == len(words)

    def condition(positive: Iterable[int], negative: Iterable[int]) -> object:
        impossible = not never.isdisjoint(positive) or not always.isdisjoint(negative)
        return None if impossible else (named(positive), named(negative))

    def named(facts: Iterable[int]) -> frozenset[str]:
        return frozenset(words[fact] for fact in facts if fact in words)

    actions = Counter(
        (
            frozenset(task.agents[i] for i in action.participants),
            action.cost,
            before,
            named(action.add),
            named(action.delete),
        )
        for action in task.actions
        if (before := condition(action.pre, action.neg)) is not None
    )
    goals = [condition(goal.positive, goal.negative) for goal in (task.goal, task.robot_goal)]
    return task.agents, task.human, actions, named(task.init), goals


def compared(before: Result, after: Result) -> str:
    """Whether two answers agree as far as they are proved."""
    proved = [result.status in ("optimal", "infeasible") for result in (before, after)]
    if not all(proved):
        return "proved both ways by none" if not any(proved) else "proved one way only within the limit"
    same = (before.status, before.cost, before.objective) == (after.status, after.cost, after.objective)
    return "same" if same else f"differ: {before.status} {before.cost}, {after.status} {after.cost}"


def files(checkout: Path) -> Iterator[tuple[str, str]]:
    """The library's teams, as they are and as its writer writes them."""
    from unified_planning.io.ma_pddl_writer import MAPDDLWriter
    from unified_planning.test.examples.multi_agent import get_example_problems

    sys.path[:0] = [str(checkout / "up_test_cases")]
    cases = {**get_example_problems(), **importlib.import_module("builtin.multiagent").get_test_cases()}
    for name, case in cases.items():
        human = case.problem.agents[0].name
        for unfactored in (False, True):
            way = "unfactored" if unfactored else "factored"
            with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
                warnings.simplefilter("ignore")
                writer = MAPDDLWriter(case.problem, unfactored=unfactored)
                writer.write_ma_domain(folder)
                writer.write_ma_problem(folder)
                try:
                    task = written(Path(folder), human)
                except SerendipityError as error:
                    yield name, f"{way}: refused: {str(error).replace(folder, '')}"
                    continue
            first = from_problem(case.problem, human=human)
            yield name, f"{way}: {compared(serendipity.plan(first, **TEAM), serendipity.plan(task, **TEAM))}"


def written(folder: Path, human: str) -> Task:
    """What the library's writer has written."""
    if (folder / "domain.pddl").exists():
        return serendipity.load_pddl(folder / "domain.pddl", folder / "problem.pddl", human)
    pairs = {
        path.name.removesuffix("_domain.pddl"): (path, folder / path.name.replace("_domain", "_problem"))
        for path in sorted(folder.glob("*_domain.pddl"))
    }
    return serendipity.load_agents(pairs, human=human)


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
