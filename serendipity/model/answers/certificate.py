"""A second opinion on a result, claim by claim (schema ``serendipity.certificate/1``)."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Literal, get_args

from serendipity.model.errors import UsageError
from serendipity.model.task.plans import PlanStep
from serendipity.model.telling import Grid, Line, Told, json_of

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
class Claim:
    """One claim of a result, and what the verifier says of it.

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

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        example = self.counterexample
        return {
            "claim": self.claim,
            "verdict": self.verdict,
            "reason": self.reason,
            "counterexample": None if example is None else [step.to_dict() for step in example],
            "seconds": self.seconds,
            "bound": self.bound,
            "method": self.method,
            "size": dict(self.size),
            "solver_calls": self.solver_calls,
        }


@dataclass(frozen=True, slots=True, repr=False)
class Certificate(Told):
    """What the verifier says of a result.

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
        return {
            "schema": SCHEMA,
            "verdict": self.verdict,
            "claims": [claim.to_dict() for claim in self.claims],
            "solver": self.solver,
            "encoding": self.encoding,
            "size": dict(self.size),
            "solver_calls": self.solver_calls,
            "elapsed_seconds": self.elapsed_seconds,
        }

    def to_json(self) -> str:
        """The JSON text, as the command line writes it."""
        return json_of(self.to_dict())

    def told(self) -> Iterator[Line | Grid]:
        """What ``verify`` prints."""
        from serendipity.model.answers.words import claims, verdict

        yield from (claims(self), Line(), verdict(self))

    def _in_short(self) -> Iterator[str]:
        """What stands between the brackets of its ``repr``."""
        yield repr(self.verdict)
        yield from (f"{claim.claim} {claim.verdict}" for claim in self.claims if claim is self.refuted)
        yield f"{len(self.claims)} claims"
