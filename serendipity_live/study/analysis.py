"""What a study has found, from the table of its rounds: means by condition, with intervals of 95 %.

``python -m serendipity_live.study.analysis rounds.csv`` prints them; ``--attentive`` leaves out who has not
understood or not attended, ``--plot FILE`` draws them.  Rounds of one person depend on each other, so they
are averaged first, and means and intervals (Student's t) are over persons.  Only finished participants count,
practice does not; differences are to the first condition (Welch's t).
"""

import argparse
import csv
import math
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import fmean, variance
from typing import TYPE_CHECKING, Final, NamedTuple

from serendipity.model import InputError, SerendipityError, UsageError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MEASURES: Final = ("spared", "saved", "seconds", "thinking_seconds", "helped", "taken")
_CONDITIONS: Final = ("none", "silent", "announced")
_SURE: Final = 0.95

Row = dict[str, str]


class Estimate(NamedTuple):
    """A mean with its interval; None where there are too few persons for one."""

    persons: int
    mean: float
    half_width: float | None

    def __str__(self) -> str:
        return f"{self.mean:.3g}" + ("" if self.half_width is None else f" ± {self.half_width:.2g}")


def read_rounds(file: Path, *, attentive: bool = False) -> list[Row]:
    """The rounds that count, perhaps without participants who have not understood, or were inattentive."""
    try:
        with file.open(encoding="utf-8", newline="") as opened:
            rows = list(csv.DictReader(opened))
        counted = [r for r in rows if r["state"] == "finished" and int(r["round"]) > 0]
        if attentive:
            out = {
                r["participant"] for r in counted if r["understood"] == "never" or r["attentive"] == "false"
            }
            counted = [row for row in counted if row["participant"] not in out]
        for row in counted:
            alone = float(row["alone_cost"])
            row["spared"] = str(alone - float(row["human_cost"]))
            row["saved"] = str(alone - float(row["team_cost"]))
    except (OSError, KeyError, TypeError, ValueError):
        raise InputError("expected rounds.csv, as the experimenter's page has it", file) from None
    return counted


def by_person(rows: Iterable[Row], measure: str) -> dict[str, list[float]]:
    """The mean of a measure for each person, by condition; without those of whom it is not told."""
    told: dict[tuple[str, str], list[float]] = {}
    for row in rows:
        if row.get(measure):
            told.setdefault((row["condition"], row["participant"]), []).append(float(row[measure]))
    means: dict[str, list[float]] = {}
    for (condition, _), values in told.items():
        means.setdefault(condition, []).append(fmean(values))
    return {name: means[name] for name in _CONDITIONS if name in means}


def estimate(values: Sequence[float]) -> Estimate:
    """The mean over persons."""
    count = len(values)
    width = _quantile(count - 1) * math.sqrt(variance(values) / count) if count > 1 else None
    return Estimate(count, fmean(values), width)


def difference(values: Sequence[float], base: Sequence[float]) -> Estimate:
    """How much more the first have in the mean."""
    count, mean = len(values) + len(base), fmean(values) - fmean(base)
    if min(len(values), len(base)) < 2:
        return Estimate(count, mean, None)
    shares = [variance(group) / len(group) for group in (values, base)]
    if sum(shares) == 0:
        return Estimate(count, mean, 0.0)
    spread = sum(s * s / (len(g) - 1) for s, g in zip(shares, (values, base), strict=True))
    return Estimate(count, mean, _quantile(sum(shares) ** 2 / spread) * math.sqrt(sum(shares)))


def _quantile(freedom: float) -> float:
    """Student's t for a two-sided interval, by bisection; its distribution by Simpson's rule."""
    norm = math.exp(math.lgamma((freedom + 1) / 2) - math.lgamma(freedom / 2)) / math.sqrt(freedom * math.pi)

    def within(t: float, parts: int = 2_000) -> float:
        step, power = t / parts, -(freedom + 1) / 2
        heights = [norm * math.pow(1 + (i * step) ** 2 / freedom, power) for i in range(parts + 1)]
        return 2 * step / 3 * (heights[0] + heights[-1] + 4 * sum(heights[1::2]) + 2 * sum(heights[2:-1:2]))

    low, high = 1.0, 13.0
    for _ in range(30):
        middle = (low + high) / 2
        low, high = (middle, high) if within(middle) < _SURE else (low, middle)
    return high


def summary(rows: Sequence[Row]) -> str:
    """All measures and answers, in words."""
    answers = [name for name in (rows[0] if rows else {}) if name.startswith(("answer_", "closing_"))]
    lines = [f"{len({row['participant'] for row in rows})} finished participants, {len(rows)} rounds"]
    for measure in (*_MEASURES, *answers):
        try:
            groups = by_person(rows, measure)
        except ValueError:
            continue  # a text, or a choice
        lines += [f"\n{measure}"] if groups else []
        base = next(iter(groups.values()), [])
        for name, values in groups.items():
            found = estimate(values)
            more = "" if values is base else f"   {difference(values, base)} more than {next(iter(groups))}"
            lines.append(f"  {name:10} n = {found.persons:<3} {found!s:18}{more}".rstrip())
    return "\n".join(lines) + "\n"


def drawn(rows: Sequence[Row], measures: Sequence[str] = ("spared", "saved")) -> "Figure":
    """Means with their intervals by condition, and a point for each person."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise UsageError("--plot: needs matplotlib: install serendipity-planner[plot]") from None
    figure = Figure(figsize=(3.2 * len(measures), 3.2), layout="constrained")
    for number, measure in enumerate(measures, start=1):
        axes = figure.add_subplot(1, len(measures), number)
        groups = by_person(rows, measure)
        for place, values in enumerate(groups.values()):
            found = estimate(values)
            axes.plot([place] * len(values), values, "o", color="0.8", markersize=4)
            axes.errorbar(place, found.mean, found.half_width or 0, fmt="s", color="C0", capsize=5)
        axes.set_xticks(range(len(groups)), list(groups))
        axes.set_title(measure)
    return figure


def main(arguments: Sequence[str]) -> int:
    """Print the summary of a file, and draw it where that is asked for."""
    parser = argparse.ArgumentParser(prog="python -m serendipity_live.study.analysis")
    parser.add_argument("rounds", type=Path, help="rounds.csv, as the experimenter's page has it")
    parser.add_argument("--attentive", action="store_true", help="only who has understood and attends")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="draw means and intervals, as SVG or PNG")
    asked = parser.parse_args(arguments)
    try:
        rows = read_rounds(asked.rounds, attentive=asked.attentive)
        sys.stdout.write(summary(rows))
        if asked.plot is not None:
            drawn(rows).savefig(asked.plot)
    except (SerendipityError, ValueError, OSError) as error:
        sys.stderr.write(f"Error: {error}\n")
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
