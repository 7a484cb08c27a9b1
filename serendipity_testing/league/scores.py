"""What helpers came to: a row for each case, and a table of all of them."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from fractions import Fraction
from random import Random
from statistics import fmean
from typing import Any, Final

from serendipity.model import Table
from serendipity.model.table import Tabular, table_of
from serendipity.model.telling import Grid, Line, Output, as_html, as_page, counted, wide
from serendipity_testing.league.cases import Case
from serendipity_testing.league.play import PersonPlayed

SCHEMA: Final = "serendipity.league/1"

_SAMPLES: Final = 1000
"""Of the bootstrap."""

_SURE: Final = 0.95

_COLUMNS: Final = {
    "regret": "what the person paid beyond the least that they pay if helped by whoever knows the same",
    "95 %": "between which it lies, if other cases of the season had been drawn (bootstrap)",
    "saved": "the share of what could be saved that was saved",
    "harmed": "persons who paid more than alone",
    "harm": "how much more, in the mean over all persons",
    "later": "epochs that persons came later than alone",
    "in time": "decisions within the deadline",
    "bad": "answers that were none",
}
"""Of the table, and what they mean."""


@dataclass(frozen=True, slots=True)
class Score:
    """A case played by a helper; figures of persons are means by the probabilities of their plans.

    Attributes:
        helper: who.
        case: season, family and number.
        family: of the task.
        plans: how many the person may have been about to follow.
        alone: what they pay alone.
        optimum: the least that they pay, helped by whoever knows the same; where it is not ``proved``, a
            lower bound.
        proved: whether that is proved.
        paid: what they paid.
        regret: ``paid - optimum``; 0 at least.
        harmed: the share of persons who paid more than alone.
        harm: how much more.
        later: epochs that they came later than alone.
        lost: the share of those who never got there.
        decisions: that were asked for, over all persons.
        late: those that came too late.
        bad: answers that were none.
        fault: what was wrong with the first of them.
    """

    helper: str
    case: str
    family: str
    plans: int
    alone: float
    optimum: float
    proved: bool
    paid: float
    regret: float
    harmed: float
    harm: float
    later: float
    lost: float
    decisions: int
    late: int
    bad: int
    fault: str | None


def score(helper: str, case: Case, played: Sequence[PersonPlayed]) -> Score:
    """The row of a case."""

    def mean(figure: Callable[[PersonPlayed], Fraction | int]) -> Fraction:
        return sum((one.scenario.probability * figure(one) for one in played), Fraction(0))

    def more(one: PersonPlayed) -> Fraction:
        return max(one.paid - one.scenario.alone, Fraction(0))

    def later(one: PersonPlayed) -> int:
        return max((one.arrived or 0) - len(one.scenario.plan), 0)

    paid = mean(lambda one: one.paid)
    faults = [fault for one in played for fault in one.faults]
    return Score(
        helper=helper,
        case=case.name,
        family=case.family,
        plans=len(played),
        alone=float(mean(lambda one: one.scenario.alone)),
        optimum=float(case.optimum),
        proved=case.proved,
        paid=float(paid),
        regret=float(max(paid - case.optimum, Fraction(0))),
        harmed=float(mean(lambda one: more(one) > 0)),
        harm=float(mean(more)),
        later=float(mean(later)),
        lost=float(mean(lambda one: one.arrived is None)),
        decisions=sum(one.epochs for one in played),
        late=sum(one.late for one in played),
        bad=len(faults),
        fault=faults[0] if faults else None,
    )


@dataclass(frozen=True, slots=True)
class Standing:
    """What a helper came to over some cases; means.

    Attributes:
        low: the lower end of the 95 % interval of ``regret``.
        high: its upper end.
        saved: the share of what could be saved that was saved; None where nothing could be.
        in_time: the share of decisions within the deadline.
        unproved: cases whose optimum has no proof.
    """

    helper: str
    cases: int
    regret: float
    low: float
    high: float
    saved: float | None
    harmed: float
    harm: float
    later: float
    lost: float
    in_time: float
    bad: int
    unproved: int


def standing(rows: Sequence[Score], seed: str) -> Standing:
    """A helper's rows together; the same seed draws the same cases for each helper's interval."""
    low, high = interval([row.regret for row in rows], seed)
    could = sum(row.alone - row.optimum for row in rows)
    saved = sum(row.alone - row.paid for row in rows)
    decisions = sum(row.decisions for row in rows)
    means = {
        name: fmean(getattr(row, name) for row in rows)
        for name in ("regret", "harmed", "harm", "later", "lost")
    }
    return Standing(
        helper=rows[0].helper,
        cases=len(rows),
        low=low,
        high=high,
        saved=saved / could if could else None,
        in_time=1 - sum(row.late for row in rows) / decisions if decisions else 1.0,
        bad=sum(row.bad for row in rows),
        unproved=sum(not row.proved for row in rows),
        **means,
    )


def interval(values: Sequence[float], seed: str) -> tuple[float, float]:
    """Between which the mean lies, by the percentiles of means of cases drawn anew (bootstrap)."""
    dice = Random(seed)
    means = sorted(fmean(dice.choices(values, k=len(values))) for _ in range(_SAMPLES))
    cut = round(_SAMPLES * (1 - _SURE) / 2)
    return means[cut], means[-cut - 1]


@dataclass(frozen=True, slots=True, repr=False)
class League(Tabular, Output):
    """A season, played.

    Attributes:
        season: its name.
        deadline: seconds for each decision, or None.
        rows: one for each helper and case.
    """

    season: str
    deadline: float | None
    rows: tuple[Score, ...]

    def table(self) -> Table:
        """A row for each helper and case."""
        return table_of(Score, self.rows)

    def standings(self, family: str | None = None) -> tuple[Standing, ...]:
        """The helpers, the least regret first; over all cases, or those of a family."""
        of: dict[str, list[Score]] = {}
        for row in self.rows:
            if family in (None, row.family):
                of.setdefault(row.helper, []).append(row)
        return tuple(
            sorted((standing(rows, self.season) for rows in of.values()), key=lambda one: one.regret)
        )

    def told(self) -> Iterator[Line | Grid]:
        """The table, what its columns mean, and what was wrong."""
        families = list(dict.fromkeys(row.family for row in self.rows))
        each = {name: {one.helper: one for one in self.standings(name)} for name in families}
        limit = "no deadline" if self.deadline is None else f"{self.deadline:g} s a decision"
        every = self.standings()
        cases = every[0].cases if every else 0
        yield Line(f"season {self.season}: {counted(cases, 'case')}, {limit}", "bold")
        yield Line()
        head = ["helper", "regret", "95 %", *families, *list(_COLUMNS)[2:]]
        lines = [[*_cells(one, [each[name][one.helper] for name in families])] for one in every]
        yield Grid(head, lines)
        yield Line()
        yield from (Line(f"{name}: {meaning}") for name, meaning in _COLUMNS.items())
        if any(one.unproved for one in every):
            yield Line("*: of some cases the optimum is not proved; the regret is that much at most")
        yield from self._faults(every)

    def _faults(self, every: Iterable[Standing]) -> Iterator[Line]:
        for one in every:
            faults = [row.fault for row in self.rows if row.helper == one.helper and row.fault is not None]
            if faults:
                yield Line(f"{one.helper}: {counted(one.bad, 'bad answer')}, the first: {faults[0]}", "red")
            if one.lost:
                yield Line(f"{one.helper}: {one.lost:.1%} of the persons never got there", "red")

    def page(self) -> str:
        """The same as a page of HTML."""
        return as_page(f"League, season {self.season}", wide(as_html(self.told())))

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        return {
            "schema": SCHEMA,
            "season": self.season,
            "deadline": self.deadline,
            "standings": [asdict(one) for one in self.standings()],
            "rows": [asdict(row) for row in self.rows],
        }

    def _in_short(self) -> Iterable[str]:
        yield f"season {self.season}"
        yield from (f"{one.helper} {one.regret:.3g}" for one in self.standings())


def _cells(one: Standing, families: Iterable[Standing]) -> Iterator[str]:
    yield one.helper
    yield _marked(one)
    yield f"{one.low:.2f} to {one.high:.2f}"
    yield from map(_marked, families)
    yield "-" if one.saved is None else f"{one.saved:.0%}"
    yield f"{one.harmed:.1%}"
    yield from (f"{figure:.2f}" for figure in (one.harm, one.later))
    yield f"{one.in_time:.1%}"
    yield str(one.bad)


def _marked(one: Standing) -> str:
    return f"{one.regret:.2f}{'*' if one.unproved else ''}"
