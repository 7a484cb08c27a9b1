"""A second opinion on a result, claim by claim (schema ``serendipity.certificate/1``)."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Literal, get_args

from serendipity.model.answers.fields import Written, written
from serendipity.model.errors import UsageError
from serendipity.model.numbers import plain_seconds
from serendipity.model.task.plans import PlanStep
from serendipity.model.telling import Grid, Line, Output

SCHEMA: Final = "serendipity.certificate/1"
CLAIMS: Final = (
    "replay",
    "cost",
    "window",
    "lower_bound",
    "optimal",
    "no_opportunity",
    "infeasible",
    "realised",
)
Verdict = Literal["proved", "refuted", "undecided"]
ClaimVerdict = Literal["proved", "refuted", "undecided", "not_in_scope"]
VERDICTS: Final[tuple[ClaimVerdict, ...]] = get_args(ClaimVerdict)


@dataclass(frozen=True, slots=True)
class Claim(Written):
    """One claim of a result, and the verifier's verdict on it.

    Attributes:
        claim: one of ``CLAIMS``.
        verdict: ``proved``, ``refuted``, ``undecided`` (the limit came first) or
            ``not_in_scope`` (nothing was tried; ``reason`` says why).
        reason: one line for people.
        counterexample: a plan that refutes the claim, where there is one.
        seconds: time spent on it.
        bound: what was proved about the objective, in the domain's unit: no answer has a
            smaller one.  None where the claim says nothing of it.
        method: what decided it, where rules alone can't: ``program`` (integer programs) or ``exhaustive``.
        size: of the method's largest program: ``columns`` and ``rows``; or of its largest search: ``states``.
        solver_calls: number of programs that a solver was given; 0 where reachability and shortest
            paths left no plan to ask about.

    Raises:
        UsageError: there is no such claim or verdict.
    """

    claim: str
    verdict: ClaimVerdict
    reason: str
    counterexample: tuple[PlanStep, ...] | None = None
    seconds: float = 0.0
    bound: float | None = None
    method: str | None = None
    size: Mapping[str, int] = field(default_factory=dict)
    solver_calls: int = 0

    def __post_init__(self) -> None:
        if self.claim not in CLAIMS:
            raise UsageError(f"claim: expected one of {', '.join(CLAIMS)}, got '{self.claim}'")
        if self.verdict not in VERDICTS:
            raise UsageError(f"verdict: expected one of {', '.join(VERDICTS)}, got '{self.verdict}'")


@dataclass(frozen=True, slots=True, repr=False)
class Certificate(Output):
    """The verifier's verdict on a result, claim by claim.

    Attributes:
        claims: in the order in which they were examined.
        elapsed_seconds: time from question to verdict.
        solver: name and version, or None where no solver was asked.
        encoding: of the integer program, or None.
        size: numbers of ``variables`` and ``constraints`` of the largest integer program.
        solver_calls: number of programs that the solver was given.
    """

    claims: tuple[Claim, ...]
    elapsed_seconds: float
    solver: str | None = None
    encoding: str | None = None
    size: dict[str, int] = field(default_factory=dict)
    solver_calls: int = 0

    @property
    def verdict(self) -> Verdict:
        """``refuted`` if a claim is, else ``undecided`` if one is or none is proved, else ``proved``."""
        verdicts = {claim.verdict for claim in self.claims}
        return next((each for each in ("refuted", "undecided", "proved") if each in verdicts), "undecided")

    @property
    def refuted(self) -> Claim | None:
        """The first claim that is refuted, or None."""
        return next((claim for claim in self.claims if claim.verdict == "refuted"), None)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        names = ("claims", "solver", "encoding", "size", "solver_calls", "elapsed_seconds")
        return {"schema": SCHEMA, "verdict": self.verdict, **written(self, names)}

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``verify`` prints."""
        yield from (claims_told(self), Line(), verdict_told(self))

    def _in_short(self) -> Iterator[str]:
        yield repr(self.verdict)
        yield from (f"{claim.claim} {claim.verdict}" for claim in self.claims if claim is self.refuted)
        yield f"{len(self.claims)} claims"


def verdict_told(certificate: Certificate) -> Line:
    """The verdict of a certificate in a line."""
    wrong = certificate.refuted
    if wrong is not None:
        line, style = f"refuted, {wrong.claim}: {wrong.reason}", "bold red"
    elif certificate.verdict == "undecided":
        left = next((claim for claim in certificate.claims if claim.verdict == "undecided"), None)
        line = "has no answer to check" if left is None else f"undecided, {left.claim}: {left.reason}"
        style = "yellow"
    else:
        proved = [claim.claim for claim in certificate.claims if claim.verdict == "proved"]
        line, style = f"proves {', '.join(proved)}" if proved else "finds nothing wrong", "green"
    return Line(f"checker: {line} ({plain_seconds(certificate.elapsed_seconds)})", style)


def claims_told(certificate: Certificate) -> Grid:
    """The claims of a certificate, one a row."""
    rows = [
        (claim.claim, claim.verdict.replace("_", " "), plain_seconds(claim.seconds), claim.reason)
        for claim in certificate.claims
    ]
    return Grid(("claim", "verdict", "time", "reason"), rows)
