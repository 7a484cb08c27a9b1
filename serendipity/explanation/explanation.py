"""What an explanation consists of, and its JSON form (schema ``serendipity.explanation/1``)."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import Any, Final

from serendipity.explanation.ask import Parts, Threshold
from serendipity.explanation.misses import Miss, Moment
from serendipity.facade.interruptibility import Removal
from serendipity.model import Result
from serendipity.model.answers.fields import written
from serendipity.model.telling import Grid, Line, Output

SCHEMA: Final = "serendipity.explanation/1"

_OF_ANSWER: Final = ("mode", "opportunity", "human_cost", "cost", "saving", "reason")


@dataclass(frozen=True, slots=True, repr=False)
class Explanation(Output):
    """Why an answer is what it is.

    Attributes:
        removal: what disappears from the human's plan and what replaces it; None without help.
        parts: what the answer's plan costs; None without a plan.
        moments: each start of the window; empty where windows play no part.
        discount: where help begins to pay; None where that is not computed.
        window_weight: the greatest ``K`` at which longer interruptions help; None where not computed.
        announcement: the answer in communication mode, or None.
        misses: what would help if a rule were relaxed; empty where a robot helps anyway.
        sentences: all of it in words, topic by topic.
        limit: which limit came before everything was found out (as ``Result.reason`` has it), or None.
        left_out: what is missing for it: ``moment``, ``discount``, ``window_weight``,
            ``announcement``, ``miss``.
    """

    answer: Result
    removal: Removal | None
    parts: Parts | None
    moments: tuple[Moment, ...]
    discount: Threshold | None
    window_weight: Threshold | None
    announcement: Result | None
    misses: tuple[Miss, ...]
    sentences: tuple[tuple[str, str], ...] = ()
    limit: str | None = None
    left_out: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether nothing is missing for want of time or memory."""
        return self.limit is None

    def told(self) -> Iterator[Line | Grid]:
        """What ``explain`` prints: the sentences, topic by topic."""
        for i, (topic, several) in enumerate(groupby(self.sentences, key=lambda sentence: sentence[0])):
            yield from [Line()] if i else []
            yield Line(topic, "bold")
            yield from (Line(f"  {text}") for _, text in several)

    def _in_short(self) -> Iterator[str]:
        yield from self.answer._in_short()
        yield f"{len(self.sentences)} sentences"

    def to_dict(self) -> dict[str, Any]:
        """The JSON object (schema ``serendipity.explanation/1``)."""
        answer, gone, told = self.answer, self.removal, self.announcement
        return {
            "schema": SCHEMA,
            "complete": self.complete,
            **written(self, ("limit", "left_out")),
            **{name: getattr(answer, name) for name in _OF_ANSWER},
            "removed": None if gone is None else list(gone.removed),
            "removed_first": None if gone is None else gone.first,
            "removed_last": None if gone is None else gone.last,
            "replacement": None if gone is None else list(gone.replacement),
            "human_part": None if self.parts is None else float(self.parts.human),
            "robot_part": None if self.parts is None else float(self.parts.discounted(answer.options)),
            **written(self, ("moments",)),
            "break_even_discount": None if self.discount is None else self.discount.to_dict(),
            "break_even_window_weight": None if self.window_weight is None else self.window_weight.to_dict(),
            "announcement": None if told is None else {"cost": told.cost, "opportunity": told.opportunity},
            **written(self, ("misses",)),
            "sentences": [{"topic": topic, "text": text} for topic, text in self.sentences],
            "options": answer.options.to_dict(),
        }
