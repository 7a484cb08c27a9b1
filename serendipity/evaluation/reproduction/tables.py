"""Means and counts by discount (Table I), times by mode (Table II), the paper's examples."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from statistics import fmean, median
from typing import Any, Final

from serendipity.evaluation.reproduction.published import TABLE_1, TABLE_2, TESTS
from serendipity.evaluation.reproduction.rows import Row
from serendipity.evaluation.reproduction.run import Reproduction
from serendipity.facade.planning import plan
from serendipity.model import Window
from serendipity.scenarios.examples import example

_EXAMPLES: Final = {"room5": "III-B", "room2": "III-C", "room7": "III-D"}
_EXAMPLE_DISCOUNTS: Final = ("0.5", "0.6", "0.9")


@dataclass(frozen=True, slots=True)
class Entry:
    """One entry of Table I.

    Attributes:
        variant: a mode, or ``serendipity, best tie`` and ``serendipity, worst tie``: over
            the human's optimal plans.
        mean: mean cost over the tasks that have a plan, or None without any.
        improved: number of tasks in which a robot helps.
        tasks: number of tasks that have a plan.
        printed: mean and number in the paper, where the tasks are the paper's.
    """

    discount: Fraction
    variant: str
    mean: Fraction | None
    improved: int
    tasks: int
    printed: tuple[Fraction, int] | None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            "discount": float(self.discount),
            "variant": self.variant,
            "mean_cost": None if self.mean is None else float(self.mean),
            "improved": self.improved,
            "tasks": self.tasks,
            "paper_mean_cost": None if self.printed is None else float(self.printed[0]),
            "paper_improved": None if self.printed is None else self.printed[1],
        }


@dataclass(frozen=True, slots=True)
class Times:
    """One row of Table II, in seconds of planning calls.

    ``paper_2015`` is what the paper printed, on its machine and solver, where the tasks are the paper's.
    """

    mode: str
    calls: int
    mean: float
    median: float
    most: float
    paper_2015: float | None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            "mode": self.mode,
            "calls": self.calls,
            "mean_seconds": self.mean,
            "median_seconds": self.median,
            "max_seconds": self.most,
            "paper_2015_seconds": self.paper_2015,
        }


@dataclass(frozen=True, slots=True)
class ExampleAnswer:
    """One of the paper's examples, at one discount."""

    section: str
    name: str
    mode: str
    discount: Fraction
    human_cost: float | None
    cost: float | None
    window: Window | None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            "section": self.section,
            "example": self.name,
            "mode": self.mode,
            "discount": float(self.discount),
            "human_cost": self.human_cost,
            "cost": self.cost,
            "window": None if self.window is None else self.window.to_dict(),
        }


def table_1(run: Reproduction) -> tuple[Entry, ...]:
    """Mean costs and numbers of improved tasks, by discount and variant."""
    printed = _papers_own(run)
    entries = []
    for discount in run.discounts:
        for variant, mode, cost in _variants(run.modes):
            rows = [row for row in run.rows if row.mode == mode and row.discount == discount]
            known = TABLE_1.get(variant, TABLE_1["communication"] if variant == "composite" else {})
            entries.append(_entry(discount, variant, rows, cost, known.get(discount) if printed else None))
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
    for name, section in _EXAMPLES.items():
        task = example(name)
        for mode in ("serendipity", "communication"):
            for discount in _EXAMPLE_DISCOUNTS:
                result = plan(task, mode=mode, discount=discount)
                answers.append(
                    ExampleAnswer(
                        section, name, mode, Fraction(discount), result.human_cost, result.cost, result.window
                    )
                )
    return tuple(answers)


_Cost = Callable[[Row], Fraction | None]


def _variants(modes: Iterable[str]) -> Iterable[tuple[str, str, _Cost]]:
    for mode in modes:
        yield mode, mode, lambda row: row.cost
        if mode == "serendipity":
            yield f"{mode}, best tie", mode, lambda row: row.best_tie
            yield f"{mode}, worst tie", mode, lambda row: row.worst_tie


def _entry(
    discount: Fraction, variant: str, rows: list[Row], cost: _Cost, printed: tuple[Fraction, int] | None
) -> Entry:
    costs = [(value, row) for row in rows if (value := cost(row)) is not None]
    mean = sum((value for value, _ in costs), Fraction(0)) / len(costs) if costs else None
    improved = sum(row.human_cost is not None and value < row.human_cost for value, row in costs)
    return Entry(discount, variant, mean, improved, len(costs), printed)


def _papers_own(run: Reproduction) -> bool:
    return {row.test for row in run.rows} == TESTS
