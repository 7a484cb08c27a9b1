"""Bugs in answers over ties, and in what is thought of humans who replan."""

from itertools import islice
from typing import Any

from search.modes.simulation.eyes import Eyes
from search.modes.simulation.human import Human
from serendipity.facade import ties
from tests.verify.planted.bug import Bug, always, replaced, returning, wrapped


def _other_extreme(original: Any, answers: Any, ties: str) -> Any:
    return original(answers, "robust" if ties == "optimistic" else "optimistic")


def _stubborn(original: Any, self: Any, belief: int, intention: Any) -> Any:
    look = original(self, belief, intention)
    return type(look)(intention, look.kept, look.kept) if look.kept is not None else look


BUGS = (
    Bug(ties, "until_settled", "the canonical one only", returning(lambda answers: islice(answers, 1))),
    Bug(ties, "_extreme", "the other one", wrapped(_other_extreme)),
    Bug(ties, "_mean", "the answer for the canonical plan", replaced(lambda answers: answers[0])),
    Bug(Human, "_decide", "nothing new, if their plan works", wrapped(_stubborn)),
    Bug(Human, "accepts", "always", replaced(always(True))),
    Bug(Human, "accepts", "never", replaced(always(False))),
    Bug(Eyes, "look", "everything", replaced(lambda _eyes, _belief, state: state)),
)
