"""Means and counts by discount (Table I), times by mode (Table II), the paper's examples; as JSON and CSV."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import product
from operator import attrgetter
from statistics import fmean, median
from typing import Any, Final, NamedTuple

from serendipity.evaluation.reproduction.rows import Row
from serendipity.evaluation.reproduction.run import DISCOUNTS, Reproduction
from serendipity.facade.planning import plan
from serendipity.model.keywords import Mode
from serendipity.scenarios.examples import example
from serendipity.writing.csv_text import as_csv

SCHEMA: Final = "serendipity.reproduction/1"

TESTS: Final = frozenset(str(number) for number in range(1, 201))
"""The paper's 200 problems (Chakraborti et al., IROS 2015), by number."""

_SERENDIPITY: Final = ((9.82, 1), (9.81, 7), (9.79, 7), (9.76, 12), (9.68, 29), (9.55, 32))
_TOGETHER: Final = ((9.72, 13), (9.65, 23), (9.48, 34), (9.25, 40), (8.93, 62), (8.51, 70))

_PRINTED: Final = {"serendipity": _SERENDIPITY, "communication": _TOGETHER, "composite": _TOGETHER}

TABLE_1: Final = {
    mode: dict(zip(map(Fraction, DISCOUNTS), column, strict=True)) for mode, column in _PRINTED.items()
}
"""By mode and discount: the mean cost, and the number of problems in brackets."""

TABLE_2: Final = {"serendipity": 28.68, "communication": 33.93, "composite": 44.96}
"""Seconds by mode, on an Intel Xeon E5-1620 v2 with Gurobi, in 2015."""

_EXAMPLES: Final = {"room5": "III-B", "room2": "III-C", "room7": "III-D"}
_EXAMPLE_MODES: Final[tuple[Mode, ...]] = ("serendipity", "communication")
_EXAMPLE_DISCOUNTS: Final = ("0.5", "0.6", "0.9")


class Entry(NamedTuple):
    """One entry of Table I, over the tasks that have a plan; the paper's figures where they are its tasks.

    ``variant``: a mode, or ``serendipity, best tie`` and ``..., worst tie``: over the human's optimal plans.
    """

    discount: Fraction
    variant: str
    mean_cost: Fraction | None
    improved: int
    tasks: int
    paper_mean_cost: float | None = None
    paper_improved: int | None = None


class Times(NamedTuple):
    """One row of Table II: planning calls.

    ``paper_2015_seconds``: as printed, of its own machine and solver, where the tasks are the paper's.
    """

    mode: str
    calls: int
    mean_seconds: float
    median_seconds: float
    max_seconds: float
    paper_2015_seconds: float | None


class Tables(NamedTuple):
    """The tables of a run: Table I, Table II, and the paper's examples beside them, as JSON has those."""

    costs: Sequence[Entry]
    times: Sequence[Times]
    examples: Sequence[dict[str, Any]]


def tables(run: Reproduction) -> Tables:
    """All of them."""
    return Tables(table_1(run), table_2(run), examples())


def table_1(run: Reproduction) -> list[Entry]:
    """Mean costs and numbers of improved tasks, by discount and variant."""
    known = TABLE_1 if _papers_own(run) else {}
    entries = []
    for discount, (variant, mode, cost) in product(run.discounts, _variants(run.modes)):
        rows = ((cost(row), row.human_cost) for row in _rows(run, mode, discount))
        costs = [(value, alone) for value, alone in rows if value is not None]
        mean = sum((value for value, _ in costs), Fraction(0)) / len(costs) if costs else None
        improved = sum(alone is not None and value < alone for value, alone in costs)
        theirs = known.get(variant, {}).get(discount, (None, None))
        entries.append(Entry(discount, variant, mean, improved, len(costs), *theirs))
    return entries


def table_2(run: Reproduction) -> list[Times]:
    """Times of planning calls by mode."""
    known = TABLE_2 if _papers_own(run) else {}
    times = []
    for mode in run.modes:
        rows = (row for discount in run.discounts for row in _rows(run, mode, discount))
        told = [row.seconds for row in rows if row.status != "error"]
        seconds = told or [0.0]
        times.append(Times(mode, len(told), fmean(seconds), median(seconds), max(seconds), known.get(mode)))
    return times


def _rows(run: Reproduction, mode: str, discount: Fraction) -> Iterator[Row]:
    """Those of a call, which stand as far from each other as there are calls."""
    first = run.modes.index(mode) * len(run.discounts) + run.discounts.index(discount)
    return (run.rows[i] for i in range(first, len(run.rows), len(run.modes) * len(run.discounts)))


def examples() -> list[dict[str, Any]]:
    """Sections III-B, III-C and III-D of the paper, planned."""
    answers = []
    for (name, section), mode, discount in product(_EXAMPLES.items(), _EXAMPLE_MODES, _EXAMPLE_DISCOUNTS):
        found = plan(example(name), mode=mode, discount=discount)
        about = {"section": section, "example": name, "mode": mode, "discount": float(discount)}
        window = None if found.window is None else found.window.to_dict()
        answers.append({**about, "human_cost": found.human_cost, "cost": found.cost, "window": window})
    return answers


def _variants(modes: Iterable[str]) -> Iterator[tuple[str, str, Callable[[Row], Fraction | None]]]:
    """Variants, each with its mode and figure."""
    for mode in modes:
        yield mode, mode, attrgetter("cost")
        if mode == "serendipity":
            yield f"{mode}, best tie", mode, attrgetter("best_tie")
            yield f"{mode}, worst tie", mode, attrgetter("worst_tie")


def _papers_own(run: Reproduction) -> bool:
    return {row.test for row in run.rows} == TESTS


def as_json(run: Reproduction, tables: Tables) -> dict[str, Any]:
    """The JSON object (schema ``serendipity.reproduction/1``)."""
    return {
        "schema": SCHEMA,
        "complete": run.complete,
        "modes": list(run.modes),
        "discounts": [float(discount) for discount in run.discounts],
        "rows": [row.to_dict() for row in run.rows],
        "table_1": [*map(_plain, tables.costs)],
        "table_2": [*map(_plain, tables.times)],
        "examples": [*tables.examples],
    }


def table_as_csv(lines: Sequence[Entry] | Sequence[Times]) -> str:
    """Table I or II, one entry a line."""
    cells = (["" if value is None else value for value in _plain(line).values()] for line in lines)
    return as_csv(lines[0]._fields, cells)


def _plain(line: Entry | Times) -> dict[str, Any]:
    """A line of a table as a JSON object."""
    values = line._asdict().items()
    return {name: float(value) if isinstance(value, Fraction) else value for name, value in values}
