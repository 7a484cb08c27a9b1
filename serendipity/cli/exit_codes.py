"""What the exit codes mean: the one place that says so."""

from enum import IntEnum
from typing import Final


class ExitCode(IntEnum):
    """Exit code of every command."""

    ANSWERED = 0
    """An answer: an opportunity, a proof that there is none, a certificate that holds."""
    REFUTED = 1
    """Something is refuted: a certificate, a result (``--strict``), a task that can't be right,
    that a person gets there (``execute``)."""
    WRONG_INPUT = 2
    """Wrong usage or input: one line on stderr says what was expected; tasks of a suite are broken."""
    INFEASIBLE = 3
    """Proved: there is no plan at all."""
    UNDECIDED = 4
    """The limit came before any answer, or a certificate is undecided."""
    UNEXPECTED = 70
    """A fault of the program: one line on stderr says what to report; ``-vv`` adds the traceback."""
    INTERRUPTED = 130
    """Interrupted; the best plan found so far is still written."""


OF_STATUS: Final = {
    "optimal": ExitCode.ANSWERED,
    "feasible": ExitCode.ANSWERED,
    "infeasible": ExitCode.INFEASIBLE,
    "unknown": ExitCode.UNDECIDED,
}
"""By ``Result.status``."""

OF_VERDICT: Final = {
    "proved": ExitCode.ANSWERED,
    "refuted": ExitCode.REFUTED,
    "undecided": ExitCode.UNDECIDED,
}
"""By the verdict of a certificate."""
