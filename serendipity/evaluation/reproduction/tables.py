"""Means and counts by discount (Table I), times by mode (Table II), the paper's examples."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from itertools import product
from statistics import fmean, median
from typing import Any, Final, NamedTuple

from serendipity.evaluation.reproduction.rows import Row
from serendipity.evaluation.reproduction.run import Reproduction
from serendipity.facade.planning import plan
from serendipity.model import Window
from serendipity.model.keywords import Mode
from serendipity.scenarios.examples import example

TESTS: Final = frozenset(str(number) for number in range(1, 201))
"""The paper's 200 problems (Chakraborti et al., IROS 2015), by number."""


class Printed(NamedTuple):
    """One entry of Table I: the mean cost, and the number of problems in brackets."""

    mean: Fraction
    improved: int


def _column(text: str) -> dict[Fraction, Printed]:
    table = {}
    for entry in text.split(";"):
        discount, mean, improved = entry.split()
        table[Fraction(discount)] = Printed(Fraction(mean), int(improved))
    return table


TABLE_1: Final = {
    "serendipity": _column("0 9.82 1; 0.1 9.81 7; 0.3 9.79 7; 0.5 9.76 12; 0.7 9.68 29; 0.9 9.55 32"),
    "communication": _column("0 9.72 13; 0.1 9.65 23; 0.3 9.48 34; 0.5 9.25 40; 0.7 8.93 62; 0.9 8.51 70"),
}
"""By mode and discount; the second column stands for composite planning too."""

TABLE_2: Final = {"serendipity": 28.68, "communication": 33.93, "composite": 44.96}
"""Seconds by mode, on an Intel Xeon E5-1620 v2 with Gurobi, in 2015."""


_EXAMPLES: Final = {"room5": "III-B", "room2": "III-C", "room7": "III-D"}
_EXAMPLE_MODES: Final[tuple[Mode, ...]] = ("serendipity", "communication")
_EXAMPLE_DISCOUNTS: Final = ("0.5", "0.6", "0.9")


@dataclass(frozen=True, slots=True)
class Entry:
    """One entry of Table I.

    Attributes:
        variant: a mode, or ``serendipity, best tie`` and ``serendipity, worst tie``: over
            the human's optimal plans.
        mean_cost: over the tasks that have a plan, or None without any.
        improved: number of tasks in which a robot helps.
        tasks: number of tasks that have a plan.
        paper_mean_cost: in the paper, where the tasks are the paper's.
        paper_improved: likewise.
    """

    discount: Fraction
    variant: str
    mean_cost: Fraction | None
    improved: int
    tasks: int
    paper_mean_cost: Fraction | None = None
    paper_improved: int | None = None


@dataclass(frozen=True, slots=True)
class Times:
    """One row of Table II: planning calls.

    ``paper_2015_seconds``: as printed, of its own machine and solver, where the tasks are the paper's.
    """

    mode: str
    calls: int
    mean_seconds: float
    median_seconds: float
    max_seconds: float
    paper_2015_seconds: float | None


@dataclass(frozen=True, slots=True)
class ExampleAnswer:
    """One of the paper's examples, at one discount."""

    section: str
    example: str
    mode: str
    discount: Fraction
    human_cost: float | None
    cost: float | None
    window: Window | None


@dataclass(frozen=True, slots=True)
class Tables:
    """The tables of a run: Table I, Table II, and the paper's examples beside them."""

    costs: tuple[Entry, ...]
    times: tuple[Times, ...]
    examples: tuple[ExampleAnswer, ...]


def plain(line: Entry | Times | ExampleAnswer) -> dict[str, Any]:
    """A line of a table as a JSON object."""
    values = {each.name: getattr(line, each.name) for each in fields(line)}
    for name, value in values.items():
        if isinstance(value, Fraction):
            values[name] = float(value)
        elif isinstance(value, Window):
            values[name] = value.to_dict()
    return values


def tables(run: Reproduction) -> Tables:
    """All of them."""
    return Tables(table_1(run), table_2(run), examples())


def table_1(run: Reproduction) -> tuple[Entry, ...]:
    """Mean costs and numbers of improved tasks, by discount and variant."""
    printed = _papers_own(run)
    entries = []
    for discount in run.discounts:
        for variant, mode, cost in _variants(run.modes):
            rows = [row for row in run.rows if row.mode == mode and row.discount == discount]
            known = TABLE_1.get(variant, TABLE_1["communication"] if variant == "composite" else {})
            entry = _entry(discount, variant, rows, cost)
            if printed and discount in known:
                entry = replace(
                    entry, paper_mean_cost=known[discount].mean, paper_improved=known[discount].improved
                )
            entries.append(entry)
    return tuple(entries)


def table_2(run: Reproduction) -> tuple[Times, ...]:
    """Times of planning calls by mode."""
    printed = _papers_own(run)
    times = []
    for mode in run.modes:
        told = [row.seconds for row in run.rows if row.mode == mode and row.status != "error"]
        seconds = told or [0.0]
        paper = TABLE_2.get(mode) if printed else None
        times.append(Times(mode, len(told), fmean(seconds), median(seconds), max(seconds), paper))
    return tuple(times)


def examples() -> tuple[ExampleAnswer, ...]:
    """Sections III-B, III-C and III-D of the paper, planned."""
    answers = []
    for (name, section), mode, discount in product(_EXAMPLES.items(), _EXAMPLE_MODES, _EXAMPLE_DISCOUNTS):
        found = plan(example(name), mode=mode, discount=discount)
        told = (found.human_cost, found.cost, found.window)
        answers.append(ExampleAnswer(section, name, mode, Fraction(discount), *told))
    return tuple(answers)


_Cost = Callable[[Row], Fraction | None]


def _variants(modes: Iterable[str]) -> Iterable[tuple[str, str, _Cost]]:
    for mode in modes:
        yield mode, mode, lambda row: row.cost
        if mode == "serendipity":
            yield f"{mode}, best tie", mode, lambda row: row.best_tie
            yield f"{mode}, worst tie", mode, lambda row: row.worst_tie


def _entry(discount: Fraction, variant: str, rows: list[Row], cost: _Cost) -> Entry:
    costs = [(value, row) for row in rows if (value := cost(row)) is not None]
    mean = sum((value for value, _ in costs), Fraction(0)) / len(costs) if costs else None
    improved = sum(row.human_cost is not None and value < row.human_cost for value, row in costs)
    return Entry(discount, variant, mean, improved, len(costs))


def _papers_own(run: Reproduction) -> bool:
    return {row.test for row in run.rows} == TESTS
