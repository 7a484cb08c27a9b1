"""What an answer over scenarios says of the posterior, in terms of the task."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from serendipity.model import Condition, Result, Task
from serendipity.model.answers.fields import MalformedError
from serendipity.model.answers.recognition import SCHEMA, GoalPosterior
from serendipity.model.answers.result_parts import GoalAnswer

_MOST_DIGITS: Final = 10**6


@dataclass(frozen=True, slots=True)
class Believed:
    """What the answer says of one candidate goal; figures as in ``serendipity.recognition/1``."""

    name: str
    goal: Condition
    prior: float
    likelihood: float | None
    posterior: float
    with_observed: float | None
    without_observed: float | None
    plan: tuple[str, ...] | None


@dataclass(frozen=True, slots=True)
class Recognised:
    """The posterior that the answer rests on."""

    observed: tuple[str, ...]
    beta: float
    explained: bool
    goals: tuple[Believed, ...]


def recognised(task: Task, result: Result) -> Recognised | None:
    """The recognition; None where scenarios come from elsewhere.

    Raises:
        MalformedError: naming what is missing, of another form, or of another task.
    """
    known = result.recognition
    if known is None:
        if result.says("recognition"):
            raise MalformedError(result.malformed["recognition"])
        return None
    if known.human != result.human:
        raise MalformedError(f"statistics.recognition: expected schema '{SCHEMA}' and the result's human")
    goals = tuple(_believed(task, entry) for entry in known.goals)
    return Recognised(known.observed, known.beta, known.explained, goals)


def listed(result: Result) -> tuple[GoalAnswer, ...]:
    """What happens in each scenario.

    Raises:
        MalformedError: it is missing, or of another form.
    """
    if result.goals is None:
        raise MalformedError(result.malformed.get("goals", "statistics.goals is not a list"))
    return result.goals


def weight(probability: float) -> Fraction:
    """The rational behind a rounded probability: a simple one, if it rounds to the same."""
    exact = Fraction(probability)
    simple = exact.limit_denominator(_MOST_DIGITS)
    return simple if float(simple) == probability else exact


def _believed(task: Task, entry: GoalPosterior) -> Believed:
    return Believed(
        entry.name,
        condition(task, entry.goal),
        float(entry.prior),
        entry.likelihood,
        entry.posterior,
        None if entry.with_observed is None else float(entry.with_observed),
        None if entry.without_observed is None else float(entry.without_observed),
        entry.plan,
    )


def condition(task: Task, literals: tuple[str, ...]) -> Condition:
    """The goal that literals write down.

    Raises:
        MalformedError: one is of another task.
    """
    ids = {fact: i for i, fact in enumerate(task.facts)}
    stranger = next((text for text in literals if text.removeprefix("!") not in ids), None)
    if stranger is not None:
        raise MalformedError(f"there is no fact '{stranger.removeprefix('!')}' in the task")
    true = sorted({ids[text] for text in literals if not text.startswith("!")})
    false = sorted({ids[text[1:]] for text in literals if text.startswith("!")})
    return Condition(tuple(true), tuple(false))
