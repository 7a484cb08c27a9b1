"""Bugs in answers over ties, and in what is thought of humans who replan."""

from collections.abc import Iterator
from itertools import islice
from typing import Any

from tests.verify.planted.bug import Bug, always, replaced, wrapped


def _only_the_first(original: Any, answers: Any, *rest: Any, **keywords: Any) -> Iterator[Any]:
    yield from islice(original(answers, *rest, **keywords), 1)


def _other_extreme(original: Any, answers: Any, ties: str) -> Any:
    return original(answers, "robust" if ties == "optimistic" else "optimistic")


def _first_answer(original: Any, answers: Any) -> Any:
    return answers[0]


def _stubborn(original: Any, self: Any, belief: int, intention: Any) -> Any:
    look = original(self, belief, intention)
    return type(look)(intention, look.kept, look.kept) if look.kept is not None else look


def _all_seeing(original: Any, self: Any, belief: int, state: int) -> int:
    return state


BUGS = (
    Bug("which optimal plans are looked at", "the canonical one only", wrapped(_only_the_first)),
    Bug("which of the answers over ties counts", "the other one", wrapped(_other_extreme)),
    Bug("the mean over ties", "the answer for the canonical plan", wrapped(_first_answer)),
    Bug("what a human who looks up decides", "nothing new, if their plan works", wrapped(_stubborn)),
    Bug("whether a human takes part when asked", "always", replaced(always(True))),
    Bug("whether a human takes part when asked", "never", replaced(always(False))),
    Bug("what a local human sees", "everything", wrapped(_all_seeing)),
)
