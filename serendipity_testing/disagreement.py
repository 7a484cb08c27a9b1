"""Different answers of two methods to one call."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from serendipity_testing.generator.calls import PlanCall

_REFUTED: Final = re.compile(r"\(refuted: (.*)\)$")
_NOT_THE_BEST: Final = re.compile(r"least|best|help makes|there is a plan")
"""In whichever way it shows, that is one fault."""

_RAISED: Final = re.compile(r"(?:raised )?([A-Za-z_]\w*): ")
_PARTICULAR: Final = re.compile(r"'[^']*'|[\d.]+")
"""The parts of a fault that are of the very call: names and numbers."""


@dataclass(frozen=True, slots=True)
class Disagreement:
    """Judges that differ on a call, with what each says; or a law that the search's answer breaks.

    Attributes:
        plans: in words, with costs: a wrong one and a better one, where there are such.
    """

    call: PlanCall
    said: Mapping[str, str]
    law: str | None = None
    plans: Mapping[str, str] = field(default_factory=dict)

    @property
    def kind(self) -> tuple[str, ...]:
        """The law, or who is at fault, and in what way: what a smaller case has to share."""
        *_, last = self.said.items()
        told = [last] if self.law else self.said.items()
        faults = (f"{judge}: {_fault(words)}" for judge, words in told if _fault(words) or self.law)
        return (self.law or "", *faults)

    def __str__(self) -> str:
        return "; ".join(f"{judge}: {words}" for judge, words in self.said.items())


def _fault(words: str) -> str:
    """The kind of fault that a judge's words tell; empty where they are an answer like others."""
    refuted = _REFUTED.search(words)
    if refuted is not None:
        if _NOT_THE_BEST.search(refuted[1]):
            return "not the best"
        return _PARTICULAR.sub("_", re.split("[,:]", refuted[1])[0])
    raised = _RAISED.match(words)
    return "" if raised is None else raised[1]
