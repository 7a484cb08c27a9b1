"""The outcome of checking a proof file (schema ``serendipity.proof-check/1``)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final, Literal

from serendipity.model.answers.fields import Written, written
from serendipity.model.telling import Grid, Line, Output

SCHEMA: Final = "serendipity.proof-check/1"


@dataclass(frozen=True, slots=True)
class RefutedProgram(Written):
    """An integer program of a proof that holds.

    Attributes:
        name: what it is about.
        columns: their number.
        rows: their number.
        leaves: of the tree that refutes it.
        limit: nothing has an objective at or below it, in the program's unit; None: nothing satisfies it.
        optimum: what its solution has, one above ``limit``; None where it has no solution.
    """

    name: str
    columns: int
    rows: int
    leaves: int
    limit: int | None
    optimum: int | None


@dataclass(frozen=True, slots=True, repr=False)
class ProofCheck(Output):
    """The outcome of checking a proof file.

    Attributes:
        verdict: ``accepted`` or ``rejected``.
        reason: one line for people.
        claim: what the file says that it proves.
        compared: whether the programs were made again from a task and a result, too.
        programs: those of a proof whose arithmetic holds.
        elapsed_seconds: time from file to verdict.
    """

    verdict: Literal["accepted", "rejected"]
    reason: str
    claim: str
    compared: bool
    programs: tuple[RefutedProgram, ...]
    elapsed_seconds: float

    @property
    def accepted(self) -> bool:
        """Whether the verdict is ``accepted``."""
        return self.verdict == "accepted"

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        return {"schema": SCHEMA, **written(self)}

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``check-proof`` prints."""
        if self.programs:
            rows = [
                (
                    program.name,
                    f"{program.columns:,}",
                    f"{program.rows:,}",
                    f"{program.leaves:,}",
                    "nothing at all" if program.limit is None else f"nothing up to {program.limit}",
                    "" if program.optimum is None else str(program.optimum),
                )
                for program in self.programs
            ]
            yield Grid(("program", "columns", "rows", "leaves", "refuted", "solution"), rows)
            yield Line()
        style = "green" if self.accepted else "bold red"
        yield Line(f"{self.verdict}, {self.claim}: {self.reason}", style)

    def _in_short(self) -> Iterator[str]:
        yield repr(self.verdict)
        yield self.claim
        yield f"{len(self.programs)} programs"
