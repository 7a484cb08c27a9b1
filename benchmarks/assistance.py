"""Silent assistance on the published problems: ``python -m benchmarks.assistance [FOLDER] [options]``.

Prints a table (problem, ties, status, lower and upper value as ``human, supporter``, CPU
seconds with loading), whether the values stand in their order (semantics 7), and a summary by
domain.  The order: both together without turns <= optimistic <= fixed, and optimistic <=
expected <= robust; where a value is not proved its bounds must not contradict it.  *Together*
is the bound that the search prunes with; with ``--composite SECONDS`` it is also worked out
as the joint plan of mode ``composite`` (no horizon, strict interference, the supporter a
millionth of the price), and must lie between that bound and optimistic.
"""

import argparse
import re
import statistics
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import serendipity
from benchmarks.problems import PROBLEMS
from search import PreparedTask
from search.modes.assistance import joint_optimum
from serendipity import Task
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

TIES = ("optimistic", "fixed", "expected", "robust")
ORDER = (
    ("bound", "composite"),
    ("composite", "optimistic"),
    ("bound", "optimistic"),
    ("optimistic", "fixed"),
    ("optimistic", "expected"),
    ("expected", "robust"),
)

Costs = tuple[Fraction, Fraction]
Bounds = tuple[Costs, Costs | None]
"""A lower and an upper value; None where none is known, or none is finite."""


def problems(folder: Path) -> Iterator[tuple[str, Path, Path]]:
    """Name, the human's problem file and the supporter's, in the order of their numbers."""
    found = list(folder.glob("*/*_problem_*_prime.pddl"))
    for prime in sorted(found, key=lambda path: (path.parent.name, number(path))):
        supporter = prime.with_name(prime.name.replace("_prime", "_supporter"))
        yield f"{prime.parent.name}/{number(prime)}", prime, supporter


def number(problem: Path) -> int:
    """The number in a problem's file name."""
    return int(re.findall(r"problem_(\d+)", problem.name)[0])


def domain_of(problem: Path) -> Path:
    """The domain file beside a problem file."""
    return problem.with_name(re.sub(r"problem_\d+", "domain", problem.name))


def load(prime: Path, supporter: Path) -> Task:
    """The task of two problem files."""
    return serendipity.load_agents(
        {"prime": (domain_of(prime), prime), "supporter": (domain_of(supporter), supporter)}, human="prime"
    )


@dataclass
class Tally:
    """What the summary is made of."""

    seconds: dict[tuple[str, str], list[float]] = field(default_factory=dict)
    proved: dict[tuple[str, str], int] = field(default_factory=dict)
    compared: int = 0
    exact: int = 0
    joint: int = 0
    contradictions: list[str] = field(default_factory=list)


def main() -> int:
    """Run all problems under all ties; 1 where values do not stand in their order."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=PROBLEMS / "spa")
    parser.add_argument("--only", default="", help="part of the problems' names")
    parser.add_argument("--ties", nargs="+", default=TIES, choices=TIES)
    parser.add_argument("--time-limit", type=float, default=60)
    parser.add_argument("--composite", type=float, metavar="SECONDS", help="work the joint plan out, too")
    chosen = parser.parse_args()
    tally = Tally()
    for name, prime, supporter in problems(chosen.folder):
        if chosen.only in name:
            values: dict[str, Bounds] = {}
            for ties in chosen.ties:
                values[ties] = _solve(name, load(prime, supporter), ties, chosen.time_limit, tally)
            task = load(prime, supporter)
            values["bound"] = _bound(task, chosen.time_limit)
            if chosen.composite is not None:
                values["composite"] = _composite(task, chosen.composite)
            _compare(name, values, tally)
    _summary(tally)
    return 1 if tally.contradictions else 0


def _solve(name: str, task: Task, ties: str, time_limit: float, tally: Tally) -> Bounds:
    start = time.process_time()
    result = serendipity.plan(task, mode="assistance", ties=ties, time_limit=time_limit)
    took = time.process_time() - start
    bounds = result.bounds
    assert bounds is not None, "every answer of the mode has bounds"
    lower, upper = (", ".join(map(str, side or ["-"])) for side in (bounds.lower, bounds.upper))
    print(f"{name:<28} {ties:<11} {result.status:<10} {lower:>14} {upper:>14} {took:8.3f}", flush=True)
    key = (name.split("/")[0], ties)
    tally.seconds.setdefault(key, []).append(took)
    tally.proved[key] = tally.proved.get(key, 0) + (result.status in ("optimal", "infeasible"))
    return bounds.lower, bounds.upper


def _bound(task: Task, time_limit: float) -> Bounds:
    try:
        value = joint_optimum(PreparedTask(task), Deadline(time_limit))
    except LimitReachedError:
        value = None
    return (value, value) if value is not None else ((Fraction(0), Fraction(0)), None)


def _composite(task: Task, seconds: float) -> Bounds:
    """The joint optimum as mode ``composite`` sees it; without bounds where it is not proved."""
    nothing = (Fraction(0), Fraction(0))
    result = serendipity.plan(
        task,
        mode="composite",
        horizon="inf",
        discount="0.999999",
        interference="strict",
        time_limit=seconds,
    )
    if result.status != "optimal" or result.plan is None:
        return nothing, None
    totals = {True: Fraction(0), False: Fraction(0)}
    for step in result.plan:
        totals[step.agents == (result.human,)] += task.actions[task.named[step.action][0]].cost
    value = totals[True], totals[False]
    return value, value


def _compare(name: str, values: dict[str, Bounds], tally: Tally) -> None:
    """Whether the values of one problem stand in their order, as far as they are known."""
    tally.compared += 1
    exact = [b for b in values.values() if b[0] == b[1]]
    tally.exact += len(exact) == len(values)
    tally.joint += "composite" in values and values["composite"][1] is not None
    for less, more in ORDER:
        if less in values and more in values:
            upper = values[more][1]
            if upper is not None and values[less][0] > upper:
                tally.contradictions.append(f"{name}: {less} is above {more}")


def _summary(tally: Tally) -> None:
    print(f"\n{'domain':<28} {'ties':<11} {'proved':>10} {'median s':>10} {'max s':>10}")
    for (domain, ties), times in tally.seconds.items():
        share = f"{tally.proved[domain, ties]}/{len(times)}"
        print(f"{domain:<28} {ties:<11} {share:>10} {statistics.median(times):10.3f} {max(times):10.3f}")
    contradicted = len({text.split(":")[0] for text in tally.contradictions})
    print(f"\nIn order: {tally.compared - contradicted} of {tally.compared} problems.")
    print(f"All values proved on {tally.exact}; joint plan worked out on {tally.joint}.")
    for contradiction in tally.contradictions:
        print(contradiction)


if __name__ == "__main__":
    raise SystemExit(main())
