"""What each strategy of the search is good for: calls with all of them, and without each.

    python -m benchmarks.ablation -o FILE.jsonl [--limits 2 10] [--suites families buildings competition]
    python -m benchmarks.ablation -o FILE.jsonl --table

Limits are seconds of processor time.  A call is asked again without each strategy that made its answer
better, raised its bound or settled it, or took a twentieth of its time: without any other it would be the
same call.  What is in the file already is not asked again.  ``lost``: calls decided with it alone, by family;
``gap``: the change of the sum over all calls of log((cost + 1) / (bound + 1)) without it.
"""

import argparse
import json
import time
from collections.abc import Iterator
from math import log
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any, Final

import serendipity
from benchmarks.families import FAMILIES
from benchmarks.problems import PROBLEMS
from search.strategies.portfolio import STRATEGIES, TURNS
from serendipity import SerendipityError, Task
from serendipity.evaluation.benchmark.coverage.suite import Problem, Roles, problems, roles
from serendipity.model.resources import deadline
from serendipity.scenarios.generate import generate_usar

CALLS: dict[str, dict[str, Any]] = {
    "serendipity": {"discount": "0.9"},
    "K = 0": {"discount": "0.9", "window_weight": 0},
    "communication": {"discount": "0.9", "mode": "communication"},
    "composite": {"discount": "0.9", "mode": "composite"},
    "composite-inf": {"discount": "0.9", "mode": "composite", "horizon": "inf"},
    "individual": {"mode": "individual"},
}

_TAKES: Final = 0.05
"""A turn that takes this share of the time is looked at though nothing came of it."""

_NEEDED: Final = ("optimal-plan", "bound", "all")
"""Without these nothing is planned, or nothing proved."""


def main() -> None:
    """Ask what is not asked yet, or print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--limits", type=float, nargs="+", default=[2, 10])
    parser.add_argument("--suites", nargs="+", default=["families", "buildings", "competition"])
    parser.add_argument("--stride", type=int, default=1, help="every so many tasks of the competition")
    parser.add_argument("--table", action="store_true", help="of what is in the file")
    arguments = parser.parse_args()
    known = _read(arguments.output)
    if arguments.table:
        print("\n".join(table(known)))
        return
    deadline.time = SimpleNamespace(perf_counter=time.process_time)  # type: ignore[attr-defined]
    with arguments.output.open("a") as out:
        for suite in arguments.suites:
            for family, name, task in SUITES[suite](arguments.stride):
                for row in _ablated(family, name, task, arguments.limits, known):
                    out.write(f"{json.dumps(row)}\n")
                    out.flush()


def _read(file: Path) -> dict[tuple[Any, ...], dict[str, Any]]:
    lines = file.read_text().splitlines() if file.exists() else []
    return {_key(row): row for row in map(json.loads, lines)}


def _key(row: dict[str, Any]) -> tuple[Any, ...]:
    return row["family"], row["name"], row["call"], row["limit"], row["without"]


def _competition(stride: int) -> Iterator[tuple[str, str, Task]]:
    for problem in problems(PROBLEMS / "codmap15", (), stride):
        who = roles(problem, 2, _can_alone)
        yield f"codmap {problem.domain}", problem.name, _task(problem, who)


def _task(problem: Problem, who: Roles) -> Task:
    return serendipity.load_pddl(problem.domain_file, problem.problem_file, who.human, who.robots)


def _can_alone(problem: Problem, who: Roles) -> bool:
    try:
        return serendipity.plan(_task(problem, who), mode="individual", time_limit=3).cost is not None
    except SerendipityError:
        return False


def _buildings(_: int) -> Iterator[tuple[str, str, Task]]:
    for rooms, medkits, robots in ((13, 2, 1), (21, 3, 1), (42, 3, 2), (84, 4, 2), (84, 4, 3), (210, 6, 1)):
        for seed in (1, 2):
            name = f"{rooms} rooms, {medkits} medkits, {robots} robots, seed {seed}"
            with TemporaryDirectory() as folder:
                generate_usar(Path(folder), rooms=rooms, medkits=medkits, robots=robots, seed=seed)
                yield "buildings", name, serendipity.load(folder)


def _families(_: int) -> Iterator[tuple[str, str, Task]]:
    for name, (family, sizes) in FAMILIES.items():
        for size in sizes:
            yield name, str(size), family(Random(f"{name} {size}"), size)


SUITES = {"competition": _competition, "buildings": _buildings, "families": _families}


def _ablated(
    family: str, name: str, task: Task, limits: list[float], known: dict[tuple[Any, ...], dict[str, Any]]
) -> Iterator[dict[str, Any]]:
    """Rows that are not known yet: a call with all strategies, and without each that did anything."""
    for call in CALLS:
        for limit in limits:
            where = {"family": family, "name": name, "call": call, "limit": limit}
            whole = known.get((family, name, call, limit, ""))
            if whole is None:
                whole = _asked(task, where, "")
                yield whole
            for without in _worth_a_look(whole):
                if (family, name, call, limit, without) not in known:
                    yield _asked(task, where, without)


def _worth_a_look(row: dict[str, Any]) -> list[str]:
    tried = {}
    for part in row["tried"]:
        did = part["better"] or part["bound"] is not None or part["settled"]
        if did or part["seconds"] > _TAKES * row["limit"]:
            tried[part["name"]] = None
    turns = [turn for turn in TURNS if turn.name in tried and turn.name not in _NEEDED]
    return list(dict.fromkeys([turn.name for turn in turns] + [turn.strategy for turn in turns]))


def _asked(task: Task, where: dict[str, Any], without: str) -> dict[str, Any]:
    more = {"strategies": ",".join(f"-{name}" for name in without.split(","))} if without else {}
    begun = time.process_time()
    try:
        options = {**CALLS[where["call"]], **more, "time_limit": where["limit"]}
        answer = serendipity.plan(task.at(task.init), **options)
    except SerendipityError as error:
        return {**where, "without": without, "status": str(error), "gap": 0.0, "seconds": 0.0, "tried": []}
    return {
        **where,
        "without": without,
        "status": answer.status,
        "cost": answer.cost,
        "bound": answer.lower_bound,
        "gap": _gap(answer),
        "seconds": time.process_time() - begun,
        "tried": answer.statistics.get("strategies", []),
    }


def _gap(answer: serendipity.Result) -> float:
    if answer.status in ("optimal", "infeasible"):
        return 0.0
    if answer.cost is None:
        return 5.0
    window = 0 if answer.window is None else answer.window.end - answer.window.start
    least = max((answer.lower_bound or 0.0) - float(answer.options.window_weight) * window, 0.0)
    return log((answer.cost + 1) / (min(least, answer.cost) + 1))


def table(rows: dict[tuple[Any, ...], dict[str, Any]]) -> Iterator[str]:
    """The ablation as a table in Markdown, one line a strategy."""
    yield "| without | tried | useful | seconds | decided only with it | only without | gap without it |"
    yield "|---|---|---|---|---|---|---|"
    whole = {key[:-1]: row for key, row in rows.items() if not key[-1]}
    total = sum(row["gap"] for row in whole.values())
    parts = {turn.name: [turn.name] for turn in TURNS}
    parts.update({name: [turn.name for turn in TURNS if turn.strategy == name] for name in STRATEGIES})
    for name in dict.fromkeys(name for turn in TURNS for name in (turn.strategy, turn.name)):
        tried = [p for row in whole.values() for p in row["tried"] if p["name"] in parts[name]]
        useful = sum(bool(p["better"] or p["bound"] is not None or p["settled"]) for p in tried)
        lost: dict[str, int] = {}
        won: dict[str, int] = {}
        change = 0.0
        for key, row in whole.items():
            other = rows.get((*key, name))
            if other is None:
                continue
            change += other["gap"] - row["gap"]
            for some, one, two in ((lost, row, other), (won, other, row)):
                if _decided(one) and not _decided(two):
                    some[key[0]] = some.get(key[0], 0) + 1
        yield (
            f"| {name} | {len(tried)} | {useful} | {sum(p['seconds'] for p in tried):.0f} "
            f"| {_told(lost)} | {_told(won)} | {change:+.1f} ({change / max(total, 1e-9):+.1%}) |"
        )
    decided = sum(map(_decided, whole.values()))
    yield f"\n{len(whole)} calls, {decided} decided, sum of gaps {total:.1f}"


def _decided(row: dict[str, Any]) -> bool:
    return row["status"] in ("optimal", "infeasible")


def _told(counts: dict[str, int]) -> str:
    named = ", ".join(f"{family} {count}" for family, count in sorted(counts.items()))
    return f"{sum(counts.values())}: {named}" if counts else "0"


if __name__ == "__main__":
    main()
