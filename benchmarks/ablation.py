"""Ablation of the search: calls with all strategies, techniques and bounds, and without each.

    python -m benchmarks.ablation -o FILE.jsonl [--techniques] [OPTIONS]
    python -m benchmarks.ablation -o FILE.jsonl --table

Limits are seconds by the clock, since other processes do some of the work.  A call is asked again without
each strategy that made its answer better, raised its bound or settled it, or took a twentieth of its time:
without any other it would be the same call.  With ``--techniques`` it is asked without each technique of
the kernel and each bound instead, if it takes a hundredth of its time.  What is in the file already is not
asked again.  ``lost``: calls decided with it alone, by family; ``gap``: the change of the sum over all
calls of log((cost + 1) / (bound + 1)) without it.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import product
from math import log
from pathlib import Path
from random import Random
from typing import Annotated, Any, Final, NamedTuple

import typer

import serendipity
from benchmarks.families import FAMILIES
from benchmarks.problems import PROBLEMS, building, can_alone, of_suite, run
from benchmarks.techniques import NAMES
from benchmarks.techniques import without as doing_without
from search.strategies.portfolio import STRATEGIES, TURNS
from serendipity import SerendipityError, Task
from serendipity.evaluation.benchmark.contenders import MODES
from serendipity.evaluation.measuring.record import Lines
from serendipity.evaluation.measuring.tables import Cell, Row, as_markdown, counted, table
from serendipity.model.telling import Line

_TAKES: Final = 0.05
"""A turn that takes this share of the time is looked at though nothing came of it."""

_NEEDED: Final = ("optimal-plan", "bound", "all")
"""Without these nothing is planned, or nothing proved."""

Rows = dict[tuple[Any, ...], Row]
"""Calls by family, name, call, limit, and what they do without."""


class Pair(NamedTuple):
    """A call with all strategies; without some, where that was asked; and what those did in the first."""

    whole: Row
    other: Row | None
    parts: Sequence[Row]


def main(
    output: Annotated[Path, typer.Option("-o", "--output")],
    limits: str = "2,10",
    suites: str = "families,buildings,competition",
    stride: int = 1,
    calls: str = ",".join(MODES),
    techniques: Annotated[bool, typer.Option("--techniques")] = False,
    only_print: Annotated[bool, typer.Option("--table")] = False,
) -> None:
    """Ask what is not asked yet, or print the table of what is in the file."""
    lines = Lines(output, "a call of an ablation", (b'{"family"',))
    known = dict(lines.read(lambda row, _: (_key(row), row)))
    if only_print:
        whole = {key[:-1]: row for key, row in known.items() if not key[-1]}
        decided, gaps = sum(map(_decided, whole.values())), sum(row["gap"] for row in whole.values())
        told = Line(f"{len(whole)} calls, {decided} decided, sum of gaps {gaps:.1f}")
        names = [*dict.fromkeys(name for turn in TURNS for name in (turn.strategy, turn.name)), *NAMES]
        pairs = {(name,): _pairs(name, whole, known) for name in names}
        print(as_markdown([table(("without",), pairs, _columns(gaps)), told]), end="")
        return
    for suite in suites.split(","):
        for family, name, task in SUITES[suite](stride):
            for call, limit in product(calls.split(","), map(float, limits.split(","))):
                where = {"family": family, "name": name, "call": call, "limit": limit}
                for row in _ablated(task, where, known, _which if techniques else _worth_a_look):
                    lines.append(row)


def _key(row: Row) -> tuple[Any, ...]:
    return row["family"], row["name"], row["call"], row["limit"], row["without"]


def _competition(stride: int) -> Iterator[tuple[str, str, Task]]:
    for problem, who, _ in of_suite(PROBLEMS / "codmap15", can_alone, stride=stride):
        yield f"codmap {problem.domain}", problem.name, problem.task(who)


def _buildings(_: int) -> Iterator[tuple[str, str, Task]]:
    for rooms, medkits, robots in ((13, 2, 1), (21, 3, 1), (42, 3, 2), (84, 4, 2), (84, 4, 3), (210, 6, 1)):
        for seed in (1, 2):
            name = f"{rooms} rooms, {medkits} medkits, {robots} robots, seed {seed}"
            yield "buildings", name, building(rooms, medkits, robots, seed)


def _families(stride: int) -> Iterator[tuple[str, str, Task]]:
    every = [(name, family, size) for name, (family, sizes) in FAMILIES.items() for size in sizes]
    for name, family, size in every[::stride]:
        yield name, str(size), family(Random(f"{name} {size}"), size)


SUITES = {"competition": _competition, "buildings": _buildings, "families": _families}


def _ablated(task: Task, where: Row, known: Rows, names: Callable[[Row], Sequence[str]]) -> Iterator[Row]:
    """Rows that are not known yet: a call with all there is, and without each that may matter in it."""
    whole = known.get(_key({**where, "without": ""}))
    if whole is None:
        whole = _asked(task, where, "")
        yield whole
    for name in names(whole):
        if _key({**where, "without": name}) not in known:
            yield _asked(task, where, name)


def _worth_a_look(row: Row) -> list[str]:
    long = _TAKES * row["limit"]
    tried = {part["name"] for part in row["tried"] if _useful(part) or part["seconds"] > long}
    turns = [turn for turn in TURNS if turn.name in tried and turn.name not in _NEEDED]
    return list(dict.fromkeys([turn.name for turn in turns] + [turn.strategy for turn in turns]))


def _which(row: Row) -> Sequence[str]:
    """The techniques and bounds that a call is asked without."""
    return NAMES if row["seconds"] > 0.01 * row["limit"] else ()


def _useful(part: Row) -> bool:
    """True if a strategy made an answer better, raised its bound, or settled it."""
    return bool(part["better"] or part["bound"] is not None or part["settled"])


def _asked(task: Task, where: Row, without: str) -> Row:
    more = {"strategies": f"-{without}"} if without and without not in NAMES else {}
    about, begun = {**where, "without": without}, time.process_time()
    try:
        options = {"discount": "0.9", **MODES[where["call"]], **more, "time_limit": where["limit"]}
        with doing_without(without):
            answer = serendipity.plan(task.at(task.init), **options)
    except SerendipityError as error:
        return {**about, "status": str(error), "gap": 0.0, "seconds": 0.0, "tried": []}
    return {
        **about,
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


def _pairs(without: str, whole: Rows, rows: Rows) -> list[Pair]:
    """Every call with all strategies, beside what it is without a turn, or a strategy and all its turns."""
    of = "strategy" if without in STRATEGIES else "name"
    names = [turn.name for turn in TURNS if getattr(turn, of) == without or without in NAMES]
    return [
        Pair(row, rows.get((*key, without)), [part for part in row["tried"] if part["name"] in names])
        for key, row in whole.items()
    ]


def _columns(gaps: float) -> dict[str, Cell]:
    """Columns of the table of strategies, where ``gaps`` is the sum over all calls with it."""

    def change(of: Sequence[Pair]) -> str:
        more = sum(each.other["gap"] - each.whole["gap"] for each in of if each.other is not None)
        return f"{more:+.1f} ({more / max(gaps, 1e-9):+.1%})"

    return {
        "tried": counted(lambda each: len(each.parts)),
        "useful": counted(lambda each: sum(map(_useful, each.parts))),
        "seconds": lambda of: f"{sum(part['seconds'] for each in of for part in each.parts):.0f}",
        "decided only with it": lambda of: _told(each.whole for each in of if _lost(each.whole, each.other)),
        "only without": lambda of: _told(each.whole for each in of if _lost(each.other, each.whole)),
        "gap without it": change,
    }


def _lost(one: Row | None, other: Row | None) -> bool:
    """True if only the first of two calls is decided, and both were asked."""
    return one is not None and other is not None and _decided(one) and not _decided(other)


def _decided(row: Row) -> bool:
    return row["status"] in ("optimal", "infeasible")


def _told(calls: Iterable[Row]) -> str:
    """Number of calls, in all and by family."""
    counts = Counter(call["family"] for call in calls)
    named = ", ".join(f"{family} {count}" for family, count in sorted(counts.items()))
    return f"{counts.total()}: {named}" if counts else "0"


if __name__ == "__main__":
    run(main, __doc__)
