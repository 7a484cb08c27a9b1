"""The least objective of a question: encode, solve, replay in integers, cut what breaks a rule, repeat.

An encoding allows any plan of the human's own as a suffix.  Def. 2.0a wants an optimal one
that fits, so a solution is checked against their optimal plans; if it fails, the program
learns what suffixes from that state cost (or that there is none) and is solved again.
"""

from dataclasses import replace

from verify.base.optimal_plans import OptimalPlans
from verify.base.subproblem import WINDOW, PricedPlan, Subproblem
from verify.base.undecided import UNDECIDED, UndecidedError, during, why
from verify.limits import uses
from verify.programs import recorded
from verify.programs.effort import Effort, Minimum, ProgramEncoding
from verify.programs.mending import mended, replay, suffix_least
from verify.proofs.book import ProofReader, ProofWriter
from verify.solvers.mip import SolverOutcome


def minimise(question: Subproblem, effort: Effort, plans: OptimalPlans) -> Minimum:
    """Answer a question.

    Args:
        plans: the human's optimal plans, for suffixes that are replanned.
    """
    if question.horizon == 0:
        return _without_epochs(question, effort)
    if isinstance(effort.proof, ProofReader):
        return recorded.read(effort.proof, question, effort.encode, plans)
    asked = question.but(most=None) if effort.method == "program" else question
    rounds = _Rounds(asked, effort, plans)
    try:
        minimum = _within(question.most, rounds.run())
        if effort.proof is not None:
            rounds.write(effort.proof, question, minimum)
    except UNDECIDED as error:
        minimum = _within(question.most, Minimum("undecided", rounds.best, rounds.bound, why(error)))
    return minimum


def _without_epochs(question: Subproblem, effort: Effort) -> Minimum:
    """The empty plan, which has no window, or none."""
    too_much = (question.most or 0) < 0 or (question.most_cost or 0) < 0
    none = too_much or question.rule == WINDOW or not question.goal.holds(question.task.init)
    minimum = Minimum("none") if none else Minimum("found", PricedPlan((), None, 0, 0), 0)
    if effort.proof is not None:
        recorded.refuted_without_epochs(effort.proof, question, minimum)
    return minimum


def _within(most: int | None, minimum: Minimum) -> Minimum:
    """The answer where the objective may not exceed ``most`` units."""
    if minimum.found is None or most is None or minimum.found.objective <= most:
        return minimum
    return replace(minimum, status="none" if minimum.status == "found" else minimum.status, found=None)


class _Rounds:
    """One question: solve, mend, cut, until the best plan is known."""

    def __init__(self, question: Subproblem, effort: Effort, plans: OptimalPlans) -> None:
        self._question = question
        self._effort = effort
        self._plans = plans
        self._cuts: dict[recorded.Cut, None] = {}
        self._encoding: ProgramEncoding | None = None
        self._values: tuple[int, ...] = ()
        self.best: PricedPlan | None = None
        self.bound: int | None = None

    def run(self) -> Minimum:
        """Answer the question, or raise an UndecidedError."""
        self._effort.deadline.check()
        with during("building the program"):
            self._encoding = encoding = self._effort.encode(self._question)
        while encoding.model is not None:
            if self._effort.method == "auto" and not uses("solver"):
                raise UndecidedError("the solver is left out")
            outcome = self._effort.solve(encoding.model)
            self._values = outcome.values or ()
            if outcome.status == "infeasible" or self._is_best(encoding, outcome):
                break
        return Minimum("none") if self.best is None else Minimum("found", self.best, self.best.objective)

    def write(self, proof: ProofWriter, question: Subproblem, minimum: Minimum) -> None:
        """Write down why nothing is better than an answer of these rounds, or raise an UndecidedError."""
        assert self._encoding is not None
        model = self._encoding.model
        assert model is not None, "a proof's programs are not closed by pruning"
        recorded.write(proof, question, model, minimum, cuts=self._cuts, values=self._values)

    def _is_best(self, encoding: ProgramEncoding, outcome: SolverOutcome) -> bool:
        """Whether the best plan so far is the best of all; else the program has learned something."""
        question, window, states, found = self._question, None, None, None
        if outcome.values is not None:
            steps, window = encoding.plan(outcome.values)
            states = replay(question, steps)
            if states is None:
                raise UndecidedError("the solver's plan does not replay")
            found = mended(question, steps, window, states, self._plans)
            self.best = _better(self.best, found)
        if outcome.status == "undecided":
            self.bound = _whole(outcome.bound, self.bound)
            raise UndecidedError(outcome.reason)
        assert states is not None
        objective, cost = question.measure(steps, window)
        self._effort.calls[-1].objective, self._effort.calls[-1].cost = objective, cost
        self.bound = objective if self.bound is None else max(self.bound, objective)
        best = self.best if self._effort.proof is None else found  # what is written down is the last solution
        if best is not None and best.objective <= objective:
            return True
        assert window is not None, "only suffixes are mended"
        state = states[window.end - 1]
        if (window.end, state) in self._cuts:
            raise UndecidedError("the solver ignores a row")
        self._cuts[window.end, state] = None
        least = suffix_least(question, state, window.end, self._plans)
        encoding.bound_suffix(window.end, state, least)
        return False


def _whole(bound: float | None, known: int | None) -> int | None:
    """The solver's bound, rounded up: the objective is integral."""
    if bound is None or abs(bound) > 1e15:
        return known
    up = -int(-(bound - 1e-6) // 1)
    return up if known is None else max(up, known)


def _better(a: PricedPlan | None, b: PricedPlan | None) -> PricedPlan | None:
    if a is None or b is None:
        return a or b
    return min(a, b, key=lambda found: (found.objective, found.cost))
