"""How long robots take for what they do."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from random import Random
from typing import Final

from serendipity.model.errors import UsageError
from serendipity.model.numbers import exact

_OTHERS: Final = "*"
_EXPECTED: Final = "expected some of VERB=SECONDS or VERB=LEAST..MOST, as in move=2..4,*=1"

Span = tuple[float, float]
"""The least and the most seconds; what lies between is equally probable."""


@dataclass(frozen=True, slots=True)
class Durations:
    """Seconds by the first word of an action.

    Attributes:
        spans: of those that are named.
        others: of all others.
    """

    spans: Mapping[str, Span] = field(default_factory=dict)
    others: Span = (1.0, 1.0)

    @classmethod
    def parse(cls, text: str) -> "Durations":
        """Durations as a command line names them: ``move=2..4,hand_over=3,*=1``.

        Raises:
            UsageError: it is of another form.
        """
        spans: dict[str, Span] = {}
        for part in text.replace(" ", "").lower().split(","):
            verb, equals, value = part.partition("=")
            if not verb or not equals or verb in spans:
                raise UsageError(f"durations: {_EXPECTED}, got '{text:.60}'")
            least, dots, most = value.partition("..")
            low, high = _seconds(least), _seconds(most if dots else least)
            if low > high:
                raise UsageError(f"durations: {verb}: expected the least first, got '{value}'")
            spans[verb] = low, high
        others = spans.pop(_OTHERS, cls().others)
        return cls(spans, others)

    def draw(self, action: str, dice: Random) -> float:
        """Seconds for an action; a verb is a whole word or, in ground files, the beginning of one."""
        word = action.split()[0]
        while word not in self.spans and "_" in word:
            word = word.rpartition("_")[0]
        low, high = self.spans.get(word, self.others)
        return low if low == high else dice.uniform(low, high)


def _seconds(text: str) -> float:
    seconds = exact(text, "durations")
    if seconds < 0:
        raise UsageError(f"durations: expected seconds, got '{text}'")
    return float(seconds)
