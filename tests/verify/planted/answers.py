"""Bugs in answers over ties, and in what is thought of humans who replan."""

from collections.abc import Iterator
from itertools import islice
from typing import Any

from search.modes.simulation.eyes import Eyes
from search.modes.simulation.human import Human
from serendipity.facade import ties
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
    Bug(ties, "until_settled", "the canonical one only", wrapped(_only_the_first)),
    Bug(ties, "_extreme", "the other one", wrapped(_other_extreme)),
    Bug(ties, "_mean", "the answer for the canonical plan", wrapped(_first_answer)),
    Bug(Human, "_decide", "nothing new, if their plan works", wrapped(_stubborn)),
    Bug(Human, "accepts", "always", replaced(always(True))),
    Bug(Human, "accepts", "never", replaced(always(False))),
    Bug(Eyes, "look", "everything", wrapped(_all_seeing)),
)
