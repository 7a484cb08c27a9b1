"""The claims that need an optimiser: each a proof, a counter-example, or neither in time."""

import math
from collections.abc import Callable
from fractions import Fraction
from time import perf_counter

from serendipity.model import INFINITE, Claim, Result, Step
from serendipity.model.answers.certificate import ClaimVerdict
from serendipity.model.numbers import agrees, as_written
from verify.base import wording
from verify.base.subproblem import PricedPlan
from verify.base.undecided import UNDECIDED, UndecidedError, during, why
from verify.calls.answer import CallAnswer, answer, best_plan, is_help
from verify.calls.call import ExaminedCall, Score
from verify.calls.methods import decide, decide_without_horizon
from verify.calls.results import found_result, plan_steps
from verify.programs.alone import cost_alone
from verify.programs.effort import Attempt, SolverCall
from verify.rules import Checker
from verify.solvers.mip import solver_version

Verdict = tuple[ClaimVerdict, str, PricedPlan | None]
"""Verdict, reason, counter-example."""

_BOUNDED = ("optimal", "no_opportunity", "lower_bound")
"""Claims that bound the objective."""


def savings_fault(
    result: Result, baseline: Fraction | None, idle: Fraction | None, cost: Fraction
) -> str | None:
    """Why ``saving_alone`` or ``saving`` is wrong; None where neither is.

    Args:
        baseline: what doing nothing costs; None: it is no answer.
        idle: what the human pays at best without robots, or ``baseline``.
        cost: the result's own.
    """
    if baseline is None or idle is None:
        nothing = result.saving is None and result.saving_alone is None
        return None if nothing else wording.NOTHING_TO_COMPARE
    alone, saving = baseline - idle, baseline - cost if result.opportunity else Fraction(0)
    is_open = result.saving_alone is None and result.status == "feasible"  # a limit came first
    if not is_open and not agrees(result.saving_alone, alone):
        return wording.FIGURE.format("saving_alone", float(alone), result.saving_alone)
    if not agrees(result.saving, saving):
        return wording.FIGURE.format("saving", float(saving), result.saving)
    return None


class Examiner:
    """Examines one result of one call."""

    def __init__(self, call: ExaminedCall, result: Result, steps: tuple[Step, ...], checker: Checker) -> None:
        self.call = call
        self.result = result
        self.steps = steps
        self.checker = checker

    def claim(self, name: str, examine: Callable[[], Verdict]) -> Claim:
        """Run an examination; running out of time or memory leaves the claim undecided."""
        started = perf_counter()
        effort, bound, example = self.call.effort, None, None
        attempts, calls = mark = effort.mark
        try:
            verdict, reason, found = examine()
            if found is not None:
                self._require_valid(found)
                reason, example = self._describe(reason, found), plan_steps(self.call, found.steps)
            if verdict == "proved" and name in _BOUNDED:
                bound = self.result.lower_bound
        except UNDECIDED as error:
            verdict, reason = "undecided", why(error)
            bound = self._known(error.bound if isinstance(error, UndecidedError) else None)
            if bound is not None:
                reason += wording.KNOWN_BOUND.format(bound)
        seconds = perf_counter() - started
        made, called = effort.attempts[attempts:], effort.calls[calls:]
        if verdict == "proved" and (made or called):
            reason += self._how(made, called)
        return Claim(name, verdict, reason, example, seconds, bound, *effort.since(mark))

    def _how(self, made: list[Attempt], called: list[SolverCall]) -> str:
        """What decided the questions of a claim."""
        decided = [each for each in made if each.decided]
        states = max((each.states for each in decided if each.name != "decoupled"), default=0)
        words = "".join(wording.APART.format(each.states) for each in decided if each.name == "decoupled")
        words += wording.SEARCHED.format(states) if states else ""
        return words or (self._solved(called) if called else wording.CLOSED)

    def _solved(self, calls: list[SolverCall]) -> str:
        """What the solver said of the programs themselves, where they were to be solved whatever they are."""
        if self.call.effort.method != "program":
            return ""
        best = next((call for call in calls if call.objective is not None), None)
        solver = solver_version(self.call.effort.solver)
        largest = max(calls, key=lambda call: call.columns)
        words = wording.solved(solver, len(calls), largest.columns, largest.rows)
        if best is None or best.objective is None or best.cost is None:
            return words + wording.NO_SOLUTION
        return words + wording.optimum(self._amount(best.objective), self._amount(best.cost))

    # -- the claims

    def optimal(self) -> Verdict:
        """No plan that the mode and its options allow has a lower objective, or the same at a lower cost."""
        score = self._score()
        verdict, nothing = self._unbeaten(score, wording.BETTER), self.call.do_nothing
        if verdict[2] is None and nothing is not None and nothing < score:  # beyond max_cost, unlike pi_H
            return "refuted", wording.NOTHING_IS_BETTER, None
        return verdict

    def optimum_is_no_opportunity(self) -> Verdict:
        """A proved optimum costs no less than the answer without robots."""
        idle = self.call.idle
        if idle is not None and is_help(self.call, self._score()):
            return "refuted", wording.OPTIMUM_IS_CHEAPER.format(self._amount(idle)), None
        return "proved", wording.NO_LESS_THAN_ALONE, None

    def no_opportunity(self) -> Verdict:
        """The best plan does not cost less than the answer without robots."""
        call = self.call
        if self._usual():
            nothing = call.do_nothing
            assert nothing is not None
            return self._unbeaten(nothing, wording.OPPORTUNITY)
        best = best_plan(call)
        if best is not None and is_help(call, (best.objective, best.cost)):
            return "refuted", wording.OPPORTUNITY, best
        return "proved", wording.BEST_NO_LESS_THAN_ALONE, None

    def opportunity_is_cheaper(self) -> Verdict | None:
        """Refutes an opportunity that costs no less than doing without robots."""
        idle, score = self.call.idle, self._score()
        if idle is not None and score[1] >= idle:
            return "refuted", wording.NO_CHEAPER.format(self._amount(idle)), None
        if not is_help(self.call, score):
            return "refuted", wording.AS_WELL_ALONE, None
        return None

    def savings(self) -> Verdict | None:
        """Refutes figures that need an optimiser: ``saving`` with ``G_R``, ``saving_alone``."""
        baseline, result = self.call.baseline, self.result
        if baseline is None:
            fault = savings_fault(result, None, None, Fraction(0))
            return None if fault is None else ("refuted", fault, None)
        return None if result.plan is None else self._saved(baseline)

    def _saved(self, baseline: int) -> Verdict | None:
        """The same of a plan, where doing nothing costs so much."""
        call, result = self.call, self.result
        if self._usual():  # a window in a head start that costs may say less, and is no other plan alone
            return self._wrong_savings(baseline, baseline) if result.saving_alone else None
        idle, cost = call.idle, self._score()[1]
        assert idle is not None
        fault = self._wrong_savings(baseline, idle)
        if fault is None and not result.opportunity and call.options.windowed and cost != baseline:
            return "refuted", wording.NOTHING_COSTS.format(self._amount(baseline)), None
        return fault

    def _wrong_savings(self, baseline: int, idle: int) -> Verdict | None:
        """Refutes other figures than what doing nothing, and the human alone at best, cost make of them."""
        fault = savings_fault(self.result, *map(self.call.prices.cost, (baseline, idle, self._score()[1])))
        return None if fault is None else ("refuted", fault, None)

    def lower_bound(self) -> Verdict:
        """No answer has an objective below the bound."""
        call, bound = self.call, self.result.lower_bound
        assert bound is not None
        shift = self._window_of_nothing()
        least = shift + self._units_at_least(bound)
        nothing = call.do_nothing
        if nothing is not None and nothing[0] < least:
            return "refuted", wording.NOTHING_HAS_OBJECTIVE.format(self._amount(nothing[0] - shift)), None
        if self._robots_alone_undercut(least - shift):
            return "refuted", wording.NOTHING_HAS_OBJECTIVE.format(self._amount(call.baseline or 0)), None
        found = self._decide(least - 1)
        if found is not None:
            return "refuted", wording.BELOW_BOUND, found
        return "proved", wording.NONE_BELOW.format(bound), None

    def _robots_alone_undercut(self, least: int) -> bool:
        """Whether robots seeing to their own goals beside ``pi_H`` is the answer, and its objective is lower.

        It has no window then; where it is one of the candidates ``do_nothing`` has said so.
        """
        call = self.call
        if not (call.robots_goal and call.options.windowed) or self.result.opportunity:
            return False
        if call.baseline is None or call.baseline >= least:
            return False
        best = best_plan(call)
        return best is None or not is_help(call, (best.objective, best.cost))

    def infeasible(self) -> Verdict:
        """There is no plan at all."""
        call = self.call
        if call.needs_pi_h and call.human_plan is None:
            if cost_alone(call.task, call.options, call.effort, call.plans.alone) is None:
                return "proved", wording.ALL_VISITED, None
            return "refuted", wording.HE_HAS_A_PLAN, None
        given: CallAnswer = answer(call)
        if given.cost is None:
            return "proved", wording.NOTHING_SATISFIES, None
        return "refuted", wording.PLAN, given.found or call.idle_robots_plan

    # -- helpers

    def _known(self, units: int | None) -> float | None:
        """What a solver's bound says of the answer's objective: no more than was asked for."""
        call, claimed = self.call, self.result.lower_bound
        if units is None or claimed is None:
            return None
        units -= self._window_of_nothing()
        return min(claimed, max(0.0, float(call.prices.cost(units))))

    def _window_of_nothing(self) -> int:
        """``K`` of the one-epoch window that the objective of an answer without a window is net of."""
        call = self.call
        without = call.options.windowed and bool(call.human_plan) and not self.result.opportunity
        return call.prices.epoch if without else 0

    def _usual(self) -> bool:
        """Whether doing nothing and the answer without robots are both ``pi_H``."""
        return not self.call.robots_goal and self.call.is_optimal

    def _better(self, score: Score) -> PricedPlan | None:
        if self.call.horizon != INFINITE:
            return self.call.better(self.call.question, score)
        return self._decide(score[0] - 1)

    def _decide(self, most: int) -> PricedPlan | None:
        """Some plan with no greater objective; None: proved that there is none."""
        call = self.call
        if call.horizon == INFINITE:
            return decide_without_horizon(call.endless.below(most), call.effort, call.plans).settled()
        return decide(call.question.below(most), call.effort, call.plans).settled()

    def _score(self) -> Score:
        """Objective and cost of the result's own plan, recomputed."""
        return self.call.endless.measure(self.steps, self.result.window)

    def _units_at_least(self, amount: float) -> int:
        """The fewest units that are at least ``amount``; a float stands for the exact value it rounds."""
        scale = self.call.prices.scale
        nearest = round(as_written(amount) * scale)
        return nearest if agrees(amount, Fraction(nearest, scale)) else math.ceil(as_written(amount) * scale)

    def _amount(self, units: int) -> str:
        return f"{float(self.call.prices.cost(units)):.12g}"

    def _unbeaten(self, score: Score, refuted: str) -> Verdict:
        found = self._better(score)
        if found is not None:
            return "refuted", refuted, found
        return "proved", wording.no_better(self._amount(score[0]), tie=self.call.may_tie(score)), None

    def _describe(self, what: str, found: PricedPlan) -> str:
        cost, objective = self._amount(found.cost), self._amount(found.objective)
        return wording.described(what, cost, objective, found.window)

    def _require_valid(self, found: PricedPlan) -> None:
        """Raise an UndecidedError unless a counter-example stands."""
        with during("checking a counter-example"):
            baseline = self.call.baseline
            opportunity = self.call.human_plan is not None and (baseline is None or found.cost < baseline)
            report = self.checker.check(found_result(self.call, found, opportunity=opportunity))
        if not report.ok:
            raise UndecidedError(wording.EXAMPLE_BREAKS.format(report.first))
        if report.undecided:
            raise UndecidedError(wording.EXAMPLE_UNCHECKED.format(report.stopped or "too hard"))
