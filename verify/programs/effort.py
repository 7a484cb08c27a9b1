"""How questions are put to solvers: the encodings, the settings, and what was spent and found."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, NamedTuple, Protocol

from serendipity.model import Deadline, Step, UsageError, Window
from serendipity.model.keywords import require_one_of
from verify.base.execution import State
from verify.base.subproblem import PricedPlan, Subproblem
from verify.base.undecided import UndecidedError
from verify.programs.automata import AutomataEncoding
from verify.programs.paper import PaperEncoding
from verify.proofs.book import ProofReader, ProofWriter
from verify.solvers.mip import SOLVERS, Model, SolverOutcome, optimise


class ProgramEncoding(Protocol):
    """An encoding of a question; ``model`` is None where there is provably no plan."""

    @property
    def model(self) -> Model | None:
        """The integer program."""

    def plan(self, values: tuple[int, ...]) -> tuple[tuple[Step, ...], Window | None]:
        """The plan and the window of a solution."""

    def told(self, state: State) -> State:
        """A state as the program tells it from others: what it leaves out is as in the initial state."""

    def bound_suffix(self, xi2: int, state: State, least: int | None) -> None:
        """A suffix from ``state`` at ``xi2`` adds at least ``least`` units; with None there is none."""


ENCODINGS: Final[dict[str, Callable[[Subproblem], ProgramEncoding]]] = {
    "automata": AutomataEncoding,
    "paper": PaperEncoding,
}
"""The encodings by name; the first is the default."""


METHODS: Final = ("auto", "program", "exhaustive", "pruned")
"""What decides a question (``verify.calls.methods``); ``program``: the solver, also where the encoding could;
``pruned``: the encoding or else the solver."""


@dataclass(slots=True)
class SolverCall:
    """A program that was given to a solver.

    Attributes:
        objective: of the best plan that the program allows, in units; None where there is none, or
            none is known.
        cost: that plan's, in units.
    """

    columns: int
    rows: int
    objective: int | None = None
    cost: int | None = None


@dataclass(frozen=True, slots=True)
class Attempt:
    """The outcome of one method for a question.

    Attributes:
        name: of the method (``verify.calls.methods``).
        decided: whether that was the answer.
        states: how many an exhaustive search looked at.
    """

    name: str
    decided: bool
    states: int = 0

    @property
    def method(self) -> str:
        """``program`` or ``exhaustive``: what a claim says of it."""
        return "program" if self.name == "programs" else "exhaustive"


class NoProgramError(UsageError):
    """A proof file is asked for, and something else than programs decides."""

    def __init__(self, what: str) -> None:
        super().__init__(f"proof: there are no programs for {what}")


class Spent(NamedTuple):
    """The effort of a claim: the method that decided it, its size, and the calls of a solver.

    Attributes:
        method: ``program`` or ``exhaustive``; None where rules and shortest paths were enough.
        size: columns and rows of the largest program, or states.
        calls: the solver's.
    """

    method: str | None = None
    size: dict[str, int] = {}  # noqa: RUF012 - never changed
    calls: int = 0


@dataclass(slots=True)
class Effort:
    """The solver's settings, and what was spent under them.

    Attributes:
        encoding: one of :data:`ENCODINGS`.
        solver: one of ``verify.solvers.mip.SOLVERS``.
        method: one of :data:`METHODS`.
        proof: where what convinced is written down, or read from instead of asking a solver.
        attempts: what was made of questions, in order.
        calls: the solver's; fewer where an encoding sees by itself that there is no plan.
    """

    encoding: str = "automata"
    solver: str = "highs"
    deadline: Deadline = field(default_factory=Deadline)
    method: str = "auto"
    proof: ProofWriter | ProofReader | None = None
    attempts: list[Attempt] = field(default_factory=list)
    calls: list[SolverCall] = field(default_factory=list)

    def __post_init__(self) -> None:
        for name, known in (("method", METHODS), ("encoding", tuple(ENCODINGS)), ("solver", SOLVERS)):
            require_one_of(name, getattr(self, name), known)

    @property
    def size(self) -> dict[str, int]:
        """Columns and rows of the largest program so far."""
        largest = max(self.calls, key=lambda call: call.columns, default=SolverCall(0, 0))
        return {"variables": largest.columns, "constraints": largest.rows}

    @property
    def mark(self) -> tuple[int, int]:
        """How much has been spent, for :meth:`since`."""
        return len(self.attempts), len(self.calls)

    def since(self, mark: tuple[int, int]) -> Spent:
        """The effort since then."""
        made, called = self.attempts[mark[0] :], self.calls[mark[1] :]
        if not made and not called:
            return Spent()
        if made and made[-1].method == "exhaustive":
            states = max(attempt.states for attempt in made)
            return Spent("exhaustive", {"states": states}, len(called))
        largest = max(called, key=lambda call: call.columns, default=None)
        size = {} if largest is None else {"columns": largest.columns, "rows": largest.rows}
        return Spent("program", size, len(called))

    def encode(self, question: Subproblem) -> "ProgramEncoding":
        """The program of a question."""
        if self.method == "program" and self.encoding == "automata":
            return AutomataEncoding(question, pruned=False)
        return ENCODINGS[self.encoding](question)

    def solve(self, model: Model) -> SolverOutcome:
        """Have a program solved."""
        self.calls.append(SolverCall(len(model.upper), len(model.ends)))
        return optimise(model, solver=self.solver, deadline=self.deadline)


@dataclass(frozen=True, slots=True)
class Minimum:
    """The answer to a question.

    Attributes:
        status: ``found`` (proved best), ``none`` (proved: no plan within the limits) or
            ``undecided``.
        found: the best plan, or for ``undecided`` some plan, if any.
        bound: proved lower bound on the objective in units, or None.
        reason: why it is undecided.
        states: how many an exhaustive search looked at.
    """

    status: str
    found: PricedPlan | None = None
    bound: int | None = None
    reason: str = ""
    states: int = 0

    def proved(self) -> PricedPlan | None:
        """The best plan; None: there is provably none."""
        if self.status == "undecided":
            raise UndecidedError(self.reason)
        return self.found

    def settled(self) -> PricedPlan | None:
        """Some plan, best or not; None: there is provably none.  Or an UndecidedError with a bound."""
        if self.found is None and self.status == "undecided":
            raise UndecidedError(self.reason, self.bound)
        return self.found
