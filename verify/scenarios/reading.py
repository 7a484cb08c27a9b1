"""What an answer over scenarios says of them, in terms of the task."""

from fractions import Fraction
from typing import Final

from serendipity.model import Condition, Result, Task
from serendipity.model.answers.fields import MalformedError
from serendipity.model.answers.recognition import SCHEMA, Recognition
from serendipity.model.answers.result_parts import GoalAnswer

_MOST_DIGITS: Final = 10**6


def recognised(result: Result) -> Recognition | None:
    """The posterior that the answer rests on, or a MalformedError; None: it rests on none."""
    known = result.recognition
    if known is None and result.says("recognition"):
        raise MalformedError(result.malformed["recognition"])
    if known is not None and known.human != result.human:
        raise MalformedError(f"statistics.recognition: expected schema '{SCHEMA}' and the result's human")
    return known


def listed(result: Result) -> tuple[GoalAnswer, ...]:
    """What happens in each scenario, or raise a MalformedError."""
    if result.goals is None:
        raise MalformedError(result.malformed.get("goals", "statistics.goals is not a list"))
    return result.goals


def weight(probability: float) -> Fraction:
    """The rational behind a rounded probability: a simple one, if it rounds to the same."""
    exact = Fraction(probability)
    simple = exact.limit_denominator(_MOST_DIGITS)
    return simple if float(simple) == probability else exact


def condition(task: Task, literals: tuple[str, ...]) -> Condition:
    """The goal that literals write down, or raise a MalformedError."""
    ids = {fact: i for i, fact in enumerate(task.facts)}
    stranger = next((text for text in literals if text.removeprefix("!") not in ids), None)
    if stranger is not None:
        raise MalformedError(f"there is no fact '{stranger.removeprefix('!')}' in the task")
    true = sorted({ids[text] for text in literals if not text.startswith("!")})
    false = sorted({ids[text[1:]] for text in literals if text.startswith("!")})
    return Condition(tuple(true), tuple(false))
