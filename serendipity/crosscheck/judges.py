"""The judges: independent answers to one call, and whether they agree."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from serendipity.certify import verify
from serendipity.crosscheck.calls import PlanCall
from serendipity.model import Deadline, PlanError, Result, UsageError
from serendipity.planning import options_from, plan
from verify.solve import solve


@dataclass(frozen=True, slots=True)
class Figures:
    """What judges have to agree on; ``error`` where the call is refused."""

    status: str = "error"
    cost: float | None = None
    objective: float | None = None
    opportunity: bool = False
    saving: float | None = None

    def __str__(self) -> str:
        if self.status in ("error", "infeasible"):
            return self.status
        words = f"{self.status}, cost {self.cost}, objective {self.objective}"
        return f"{words}, opportunity" if self.opportunity else words


@dataclass(frozen=True, slots=True)
class Disagreement:
    """Judges that differ on a call, with what each says."""

    call: PlanCall
    said: Mapping[str, str]

    def __str__(self) -> str:
        return "; ".join(f"{judge}: {words}" for judge, words in self.said.items())


Judge = Callable[[PlanCall, Deadline], Result]


def _by_search(call: PlanCall, deadline: Deadline) -> Result:
    return plan(call.task, human_plan=call.human_plan, deadline=deadline, **call.keywords())


def _by_program(encoding: str, solver: str) -> Judge:
    def judge(call: PlanCall, deadline: Deadline) -> Result:
        options = options_from(call.keywords())
        return solve(
            call.task,
            options,
            human_plan=call.human_plan,
            encoding=encoding,
            solver=solver,
            deadline=deadline,
        )

    return judge


JUDGES: Final[dict[str, Judge]] = {
    "search": _by_search,
    "automata": _by_program("automata", "highs"),
    "paper": _by_program("paper", "highs"),
    "cbc": _by_program("automata", "cbc"),
}
"""Judges by name; the first is the one whose results are certified."""


def compare(
    call: PlanCall,
    judges: Mapping[str, Judge],
    time_limit: float | None = None,
    memory_limit: float | None = None,
) -> Disagreement | None:
    """Let every judge answer, and the verifier certify each answer.

    A judge that a limit stops before the proof agrees with everybody, but its answer has to
    follow the rules.

    Args:
        call: what is asked.
        judges: by name.
        time_limit: seconds for each answer, and for each certificate; or None.
        memory_limit: what the process may have in memory, in MiB, or None.
    """
    said: dict[str, str] = {}
    known: set[Figures] = set()
    sound = True
    for name, judge in judges.items():
        try:
            result = judge(call, Deadline(time_limit, memory_limit))
        except (UsageError, PlanError):
            known.add(Figures())
            said[name] = str(Figures())
            continue
        if result.status == "unknown":
            said[name] = "unknown"
            continue
        figures = figures_of(result)
        said[name] = str(figures)
        if result.status != "feasible":
            known.add(figures)
        certificate = verify(call.task, result, time_limit=time_limit, memory_limit=memory_limit)
        if certificate.verdict == "refuted":
            sound = False
            refuted = certificate.refuted
            said[name] += f" (refuted: {refuted.claim}: {refuted.reason})" if refuted else " (refuted)"
    return None if sound and len(known) <= 1 else Disagreement(call, said)


def figures_of(result: Result) -> Figures:
    """The figures of a result."""
    return Figures(result.status, result.cost, result.objective, result.opportunity, result.saving)
