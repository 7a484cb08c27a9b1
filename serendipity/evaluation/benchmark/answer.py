"""What a contender says to one call."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Answer:
    """An answer, and what it took.

    Attributes:
        seconds: processor time of the answer itself.
        status: ``optimal``, ``feasible``, ``infeasible`` or ``unknown``, as in results.
        cost: in the domain's unit; None where there is none, or the limit came first.
        process_seconds: processor time of outside processes from files to answer, where
            there are any; ``seconds`` is then a part of it, as the program itself tells.
        memory: their peak memory in MiB.
    """

    seconds: float
    status: str
    cost: float | None
    process_seconds: float | None = None
    memory: float | None = None
