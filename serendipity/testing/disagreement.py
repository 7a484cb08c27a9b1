"""What two methods say differently of one call."""

from collections.abc import Mapping
from dataclasses import dataclass

from serendipity.testing.generator.calls import PlanCall


@dataclass(frozen=True, slots=True)
class Disagreement:
    """Judges that differ on a call, with what each says; or a law that the search's answer breaks."""

    call: PlanCall
    said: Mapping[str, str]
    law: str | None = None

    def __str__(self) -> str:
        return "; ".join(f"{judge}: {words}" for judge, words in self.said.items())
