"""The least objective of a question: encode, solve, replay in integers, cut what breaks a rule, repeat.

An encoding allows any plan of the human's own as a suffix.  Def. 2.0a wants an optimal one
that fits, so a solution is checked against their optimal plans; if it fails, the program
learns what suffixes from that state cost (or that there is none) and is solved again.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final, Protocol

from serendipity.model import Deadline, Step, UsageError, Window
from verify.base.execution import State, by_epoch, states_along
from verify.base.optimal_plans import OptimalPlans
from verify.base.subproblem import WINDOW, Solution, Subproblem
from verify.base.undecided import UNDECIDED, UndecidedError, during, why
from verify.programs.automata import AutomataEncoding
from verify.programs.paper import PaperEncoding
from verify.solvers.mip import SOLVERS, Model, SolverOutcome, optimise


class ProgramEncoding(Protocol):
    """What an encoding offers; ``model`` is None where there is provably no plan."""

    @property
    def model(self) -> Model | None:
        """The integer program."""

    def plan(self, values: tuple[int, ...]) -> tuple[tuple[Step, ...], Window | None]:
        """The plan and the window of a solution."""

    def bound_suffix(self, xi2: int, state: State, least: int | None) -> None:
        """A suffix from ``state`` at ``xi2`` adds at least ``least`` units; with None there is none.

        Args:
            xi2: first epoch of the suffix.
            state: facts that hold at its begin.
            least: units of the objective, or None.
        """


ENCODINGS: Final[dict[str, Callable[[Subproblem], ProgramEncoding]]] = {
    "automata": AutomataEncoding,
    "paper": PaperEncoding,
}
"""The encodings by name; the first is the default."""


METHODS: Final = ("auto", "program")
"""What decides a question; ``program``: the solver, also where the encoding could."""


@dataclass(slots=True)
class SolverCall:
    """A program that was given to a solver.

    Attributes:
        columns: their number.
        rows: their number.
        objective: of the best plan that the program allows, in units; None where there is none, or
            none is known.
        cost: that plan's, in units.
    """

    columns: int
    rows: int
    objective: int | None = None
    cost: int | None = None


@dataclass(slots=True)
class Effort:
    """The solver's settings, and what was spent under them.

    Attributes:
        encoding: one of :data:`ENCODINGS`.
        solver: one of ``verify.solvers.mip.SOLVERS``.
        deadline: when to stop.
        method: one of :data:`METHODS`.
        programs: number of questions that were put to an encoding.
        calls: the solver's; fewer where an encoding sees by itself that there is no plan.
    """

    encoding: str = "automata"
    solver: str = "highs"
    deadline: Deadline = field(default_factory=Deadline)
    method: str = "auto"
    programs: int = 0
    calls: list[SolverCall] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise UsageError(f"method: expected one of {', '.join(METHODS)}, got {self.method!r}")
        if self.encoding not in ENCODINGS:
            raise UsageError(f"encoding: expected one of {', '.join(ENCODINGS)}, got {self.encoding!r}")
        if self.solver not in SOLVERS:
            raise UsageError(f"solver: expected one of {', '.join(SOLVERS)}, got {self.solver!r}")

    @property
    def size(self) -> dict[str, int]:
        """Columns and rows of the largest program so far."""
        largest = max(self.calls, key=lambda call: call.columns, default=SolverCall(0, 0))
        return {"variables": largest.columns, "constraints": largest.rows}

    def encode(self, question: Subproblem) -> "ProgramEncoding":
        """The program of a question."""
        self.programs += 1
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
    """

    status: str
    found: Solution | None = None
    bound: int | None = None
    reason: str = ""

    def settled(self) -> Solution | None:
        """Some plan, best or not; None: there is provably none.

        Raises:
            UndecidedError: neither is known; with the bound that is.
        """
        if self.found is None and self.status == "undecided":
            raise UndecidedError(self.reason, self.bound)
        return self.found


def minimise(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    """Answer a question.

    Args:
        question: the question.
        effort: the solver's settings.
        plans: the human's optimal plans, for suffixes that are replanned.
    """
    if question.horizon == 0:
        return _nothing_to_do(question)
    asked = question if effort.method == "auto" else question.but(most=None)
    rounds = _Rounds(asked, effort, plans)
    try:
        return _within(question.most, rounds.run())
    except UNDECIDED as error:
        return _within(question.most, Minimum("undecided", rounds.best, rounds.bound, why(error)))


def _within(most: int | None, minimum: Minimum) -> Minimum:
    """The answer where the objective may not exceed ``most`` units."""
    if minimum.found is None or most is None or minimum.found.objective <= most:
        return minimum
    return replace(minimum, status="none" if minimum.status == "found" else minimum.status, found=None)


class _Rounds:
    """One question: solve, mend, cut, until the best plan is known.

    Attributes:
        best: the best plan so far.
        bound: proved lower bound on the objective, or None.
    """

    def __init__(self, question: Subproblem, effort: Effort, plans: OptimalPlans) -> None:
        self._question = question
        self._effort = effort
        self._plans = plans
        self._cut: set[tuple[int, State]] = set()
        self.best: Solution | None = None
        self.bound: int | None = None

    def run(self) -> Minimum:
        """Answer the question.

        Raises:
            UndecidedError: the solver did not, or what it says is not so.
            LimitReachedError: the deadline came first.
        """
        self._effort.deadline.check()
        with during("building the program"):
            encoding = self._effort.encode(self._question)
        while encoding.model is not None:
            outcome = self._effort.solve(encoding.model)
            if outcome.status == "infeasible" or self._is_best(encoding, outcome):
                break
        return Minimum("none") if self.best is None else Minimum("found", self.best, self.best.objective)

    def _is_best(self, encoding: ProgramEncoding, outcome: SolverOutcome) -> bool:
        """Whether the best plan so far is the best of all; else the program has learned something."""
        question, window, states = self._question, None, None
        if outcome.values is not None:
            steps, window = encoding.plan(outcome.values)
            states = replay(question, steps)
            if states is None:
                raise UndecidedError("the solver's plan does not replay")
            self.best = _better(self.best, _mended(question, steps, window, states, self._plans))
        if outcome.status == "undecided":
            self.bound = _whole(outcome.bound, self.bound)
            raise UndecidedError(outcome.reason)
        assert states is not None
        objective, cost = question.measure(steps, window)
        self._effort.calls[-1].objective, self._effort.calls[-1].cost = objective, cost
        self.bound = objective if self.bound is None else max(self.bound, objective)
        if self.best is not None and self.best.objective <= objective:
            return True
        assert window is not None, "only suffixes are mended"
        state = states[window.end - 1]
        if (window.end, state) in self._cut:
            raise UndecidedError("the solver ignores a row")
        self._cut.add((window.end, state))
        least = _suffix_least(question, state, window.end, self._plans)
        encoding.bound_suffix(window.end, state, least)
        return False


def _whole(bound: float | None, known: int | None) -> int | None:
    """The solver's bound, rounded up: the objective is integral."""
    if bound is None or abs(bound) > 1e15:
        return known
    up = -int(-(bound - 1e-6) // 1)
    return up if known is None else max(up, known)


def _better(a: Solution | None, b: Solution | None) -> Solution | None:
    if a is None or b is None:
        return a or b
    return min(a, b, key=lambda found: (found.objective, found.cost))


def _nothing_to_do(question: Subproblem) -> Minimum:
    """No epoch at all: the empty plan or none; it has no window."""
    goals = _goals_hold(question, question.task.init)
    if not goals or question.rule == WINDOW or (question.most or 0) < 0 or (question.most_cost or 0) < 0:
        return Minimum("none")
    return Minimum("found", Solution((), None, 0, 0), 0)


def replay(question: Subproblem, steps: tuple[Step, ...]) -> list[State] | None:
    """States ``s_0 .. s_T`` of a plan, or None if it is not executable or misses a goal."""
    task, sets = question.task, by_epoch(steps)
    epochs = (sets.get(epoch, ()) for epoch in range(1, question.horizon + 1))
    states = states_along(task, epochs, strict=question.options.strict)
    return states if states is not None and _goals_hold(question, states[-1]) else None


def _goals_hold(question: Subproblem, state: State) -> bool:
    task = question.task
    return task.goal.holds(state) and (not question.robots_goal or task.robot_goal.holds(state))


def replans(question: Subproblem) -> bool:
    """Whether suffixes have to be optimal plans of the human's own (Def. 2.0a)."""
    options = question.options
    return question.rule == WINDOW and options.suffix == "replan" and options.preservation == "kernel"


def _mended(
    question: Subproblem,
    steps: tuple[Step, ...],
    window: Window | None,
    states: list[State],
    plans: OptimalPlans,
) -> Solution | None:
    """The plan with an optimal suffix: its own, or another one; None if no optimal suffix fits."""
    if not replans(question) or window is None or window.end > question.horizon:
        return Solution(steps, window, *question.measure(steps, window))
    suffix = best_suffix(question, states[window.end - 1], window.end, plans)
    if suffix is None:
        return None
    head = tuple(step for step in steps if step.epoch < window.end)
    tail = tuple(Step(window.end + k, i) for k, i in enumerate(suffix))
    found = Solution(head + tail, window, *question.measure(head + tail, window))
    return found if question.most is None or found.objective <= question.most else None


def _suffix_least(question: Subproblem, state: State, xi2: int, plans: OptimalPlans) -> int | None:
    suffix = best_suffix(question, state, xi2, plans)
    if suffix is None:
        return None
    return sum(question.prices.team[i] + question.prices.talk[i] for i in suffix)


def best_suffix(question: Subproblem, state: State, xi2: int, plans: OptimalPlans) -> tuple[int, ...] | None:
    """The optimal plan alone that is best for the objective and reaches all goals, if it fits.

    Args:
        question: goals and prices.
        state: facts that hold at the begin of ``xi2``.
        xi2: first epoch of the suffix.
        plans: the human's optimal plans.
    """
    worth = plans.worth(state)
    if worth is None or worth[1] > question.horizon - xi2 + 1:
        return None
    known: dict[State, tuple[int, tuple[int, ...]] | None] = {}

    def best_from(here: State) -> tuple[int, tuple[int, ...]] | None:
        if here not in known:
            known[here] = None
            here_worth = plans.worth(here)
            if here_worth is not None and here_worth[1] == 0:
                reached = not question.robots_goal or question.task.robot_goal.holds(here)
                known[here] = (0, ()) if reached else None
            for i, after in plans.steps(here):
                rest = best_from(after)
                if rest is not None:
                    choice = (question.prices.talk[i] + rest[0], (i, *rest[1]))
                    known[here] = min(known[here] or choice, choice)
        return known[here]

    found = best_from(state)
    return None if found is None else found[1]
