"""The answer of goal recognition, and its JSON form (schema ``serendipity.recognition/1``)."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final, NamedTuple

from serendipity.model.answers.fields import Form, MalformedError, form, list_of, mapping, read, written
from serendipity.model.numbers import plain, rounded
from serendipity.model.schemas import schema_fault
from serendipity.model.table import Table, Tabular
from serendipity.model.telling import Grid, Line, Output

SCHEMA: Final = "serendipity.recognition/1"

_COLUMNS: Final = {
    "name": str,
    "goal": str,
    "prior": float,
    "likelihood": float,
    "posterior": float,
    "cost_with_observed": float,
    "cost_without_observed": float,
    "plan": str,
}

_IN_JSON: Final = {
    "with_observed": "cost_with_observed",
    "without_observed": "cost_without_observed",
}
"""Names of fields in JSON, where they are others."""


class Errors(NamedTuple):
    """In the likeliest reading, observations that are no actions of the plan, and actions of it not seen."""

    cost: Fraction
    wrong: int
    missed: int


UNEXPLAINED: Final = "no goal explains what was observed: the posterior is the prior"


@dataclass(frozen=True, slots=True)
class GoalPosterior:
    """The posterior of one candidate goal; costs are the human's own, in the domain's unit.

    Attributes:
        name: for people.
        goal: its literals.
        prior: before the observations.
        likelihood: ``P(O | G)``; None where the human can't reach the goal alone at all.
        posterior: given the observations.
        weight: the rational that the posterior is rounded from; planning adds up these.
        with_observed: ``cost(G, O)``; None if no plan of theirs embeds the observations.
        without_observed: ``cost(G, not O)``; None if all of their plans embed them.
        plan: the canonical optimal plan that embeds the observations, or None; where observations are
            noisy, that of the likeliest reading.
        errors: of that reading; None without noise, or where there is none.
    """

    name: str
    goal: tuple[str, ...]
    prior: Fraction
    likelihood: float | None
    posterior: float
    weight: Fraction
    with_observed: Fraction | None
    without_observed: Fraction | None
    plan: tuple[str, ...] | None
    errors: Errors | None = None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        left_out = {"weight"} if self.errors else {"weight", "errors"}
        return {_IN_JSON.get(n, n): value for n, value in written(self).items() if n not in left_out}


@dataclass(frozen=True, slots=True, repr=False)
class Recognition(Tabular, Output):
    """The posterior over the human's goals.

    Attributes:
        human: the human's name.
        observed: names of the actions that were observed.
        beta: how strictly they are taken to minimise cost.
        explained: whether some candidate explains the observations; if none does, the
            posterior is the prior.
        goals: in the order in which they were given; posteriors add up to 1.
        noise: how often actions were missed and observations wrong, by name; None if neither is.
    """

    human: str
    observed: tuple[str, ...]
    beta: float
    explained: bool
    goals: tuple[GoalPosterior, ...]
    noise: dict[str, float] | None = None

    def table(self) -> Table:
        """The goals, one a row."""
        rows = tuple(
            (
                goal.name,
                ", ".join(goal.goal),
                float(goal.prior),
                goal.likelihood,
                goal.posterior,
                rounded(goal.with_observed),
                rounded(goal.without_observed),
                None if goal.plan is None else "; ".join(goal.plan),
            )
            for goal in self.goals
        )
        return Table(_COLUMNS, rows)

    @property
    def most_likely(self) -> GoalPosterior:
        """The goal with the highest posterior; the first of equals."""
        return max(self.goals, key=lambda goal: goal.posterior)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        found = {"schema": SCHEMA, **written(self)}
        return found if self.noise else {name: value for name, value in found.items() if name != "noise"}

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``recognise`` prints: the posterior, and whether it is only the prior."""
        if not self.explained:
            yield Line(UNEXPLAINED)
        best = self.most_likely
        yield Line(f"the most likely goal of {self.human} is {best.name} ({best.posterior:.4g})")
        yield Line()
        noisy = ("wrong", "missed") if self.noise else ()
        header = ("posterior", "prior", "with observed", "without", *noisy, "goal")
        rows = [
            (
                f"{goal.posterior:.4f}",
                f"{float(goal.prior):.4f}",
                plain(goal.with_observed),
                plain(goal.without_observed),
                *("-" if goal.errors is None else str(getattr(goal.errors, name)) for name in noisy),
                goal.name,
            )
            for goal in self.goals
        ]
        yield Grid(header, rows, frozenset({self.goals.index(best)}), numbered=True)

    def _in_short(self) -> Iterator[str]:
        yield f"{len(self.goals)} goals of {self.human}"
        yield f"{self.most_likely.name} {self.most_likely.posterior:.4g}"


def read_recognition(value: Any, where: str) -> Recognition:
    """The posterior that a result rests on, as :meth:`Recognition.to_dict` wrote it."""
    if fault := schema_fault(mapping(value, where).get("schema"), SCHEMA):
        raise MalformedError(f"{where}: {fault}")
    return read(Recognition, value, where)


def _read_goal(value: Any, where: str) -> GoalPosterior:
    """One goal; its weight, of which the posterior is all that was written down, is the posterior."""
    given = dict(mapping(value, where))
    given |= {name: given[key] for name, key in _IN_JSON.items() if key in given}
    return read(GoalPosterior, given | {"weight": given.get("posterior")}, where)


form(Recognition, {"goals": list_of(Form(_read_goal, GoalPosterior.to_dict))})
