"""What the rule checker reports, and the claims that come of it: ``check`` and ``verify`` make them alike."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from serendipity.model import Claim, Result

CLAIMS: Final = ("replay", "cost", "window", "lower_bound")
"""The claims of a certificate that need no solver, in the order in which they are checked."""


@dataclass(frozen=True, slots=True)
class Violation:
    """A rule that a result breaks.

    Attributes:
        claim: the claim that it refutes, one of ``CLAIMS``.
        section: where the rule stands in ``docs/semantics.md``.
        message: one line: what was found and what was expected.
    """

    rule: str
    claim: str
    section: str
    message: str
    epoch: int | None = None
    action: str | None = None

    def __str__(self) -> str:
        place = "" if self.epoch is None else f"epoch {self.epoch}: "
        what = "" if self.action is None else f"'{self.action}': "
        return f"{self.rule} (semantics {self.section}): {place}{what}{self.message}"


@dataclass(frozen=True, slots=True)
class RuleReport:
    """The verdict of all rules on one result.

    Attributes:
        violations: the first broken rule of each refuted claim, in order.
        unchecked: why a claim is not for these rules, by claim.
        undecided: why a claim could not be checked, by claim; none of its rules is known to be broken.
    """

    violations: tuple[Violation, ...]
    unchecked: Mapping[str, str]
    undecided: Mapping[str, str]
    seconds: float

    @property
    def ok(self) -> bool:
        """Whether no rule is known to be broken."""
        return not self.violations

    @property
    def stopped(self) -> str | None:
        """The limit that came before all rules were examined, or None."""
        return self.undecided.get(CLAIMS[-1])  # no rule of the last claim is ever too hard

    @property
    def first(self) -> Violation | None:
        """The first rule broken, or None."""
        return self.violations[0] if self.violations else None

    def of(self, claim: str) -> Violation | None:
        """The violation that refutes a claim, or None."""
        return next((found for found in self.violations if found.claim == claim), None)

    def claim_of(self, result: Result, name: str, followed: Mapping[str, str]) -> Claim | None:
        """One claim as far as rules decide it; None where they say nothing of it.

        Args:
            followed: what is said of claims that following the rules proves, where there is a plan.
        """
        violation = self.of(name)
        if violation is not None:
            return Claim(name, "refuted", str(violation), seconds=self.seconds)
        if name in self.unchecked:
            return Claim(name, "not_in_scope", self.unchecked[name])
        if name in self.undecided and (name == "replay" or result.plan is not None):
            return Claim(name, "undecided", self.undecided[name], seconds=self.seconds)
        if name in followed and result.plan is not None:
            return Claim(name, "proved", followed[name], seconds=self.seconds)
        return None
