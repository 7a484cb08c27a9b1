"""Proofs that no policy is better over scenarios than an answer says (semantics 11)."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from time import perf_counter

from serendipity.model import Claim, Result
from serendipity.model.answers.certificate import ClaimVerdict
from verify.base import wording
from verify.base.execution import plan_step
from verify.base.optimal_plans import OptimalPlans
from verify.base.subproblem import PricedPlan
from verify.base.undecided import UNDECIDED, why
from verify.calls.answer import best_plan
from verify.calls.call import ExaminedCall
from verify.programs.effort import Effort, NoProgramError
from verify.scenarios.check import beyond_rules
from verify.scenarios.measure import Measure
from verify.scenarios.policies import Better, PolicyEnumeration
from verify.scenarios.program import refute_policies
from verify.scenarios.timelines import (
    Figures,
    ScenarioTimeline,
    answered,
    close,
    differing,
    figures,
    measured,
)

_ROUNDED = 1 - Fraction(1, 10**9)
"""A bound that was summed from rounded probabilities may be too high by its last digits."""


class ScenariosProof:
    """The claims about an answer over scenarios, which breaks no rule, that need an optimiser."""

    def __init__(self, result: Result, lines: Sequence[ScenarioTimeline], effort: Effort) -> None:
        self.result = result
        self.lines = lines
        self.effort = effort
        options = result.options.but(horizon=result.horizon, time_limit=None)
        self._calls = []
        for line in lines:
            plans = OptimalPlans(line.task, line.case.alone)
            self._calls.append(ExaminedCall(line.task, options, line.case.pi_h, plans, effort))

    def claims(self) -> Iterator[Claim]:
        """What rules can't say: one proof for the optimum and its bound."""
        started, mark = perf_counter(), self.effort.mark
        first, *others = beyond_rules(self.result)
        better: Better | None = None
        try:
            fault = self._figures_fault()
            if fault is not None:
                yield Claim("cost", "refuted", fault, seconds=perf_counter() - started)
                return
            verdict, reason, better = self._best()
        except UNDECIDED as error:
            verdict, reason = "undecided", why(error)
        bound = self.result.lower_bound if verdict == "proved" else None
        task, discount = self.lines[0].task, self.result.options.discount
        example = None if better is None else tuple(plan_step(task, s, discount) for s in better[1])
        spent = self.effort.since(mark)
        yield Claim(first, verdict, reason, example, perf_counter() - started, bound, *spent)
        for name in others:
            yield Claim(name, verdict, wording.LIKE.format(first, reason), example, 0.0, bound, *spent)

    # -- figures

    @cached_property
    def _floors(self) -> list[Figures]:
        """What each scenario allows by itself."""
        return [self._floor(call, line) for call, line in zip(self._calls, self.lines, strict=True)]

    def _floor(self, call: ExaminedCall, line: ScenarioTimeline) -> Figures:
        """What one allows by itself: where anything is kept or paid for, regret asks by section 11."""
        if self.result.options.risk != "regret" or not (line.prices or line.task.robot_goal):
            return floor_of(call)
        measure = Measure([call], [Fraction(1)], [(Fraction(0), Fraction(0))], [line.prices])
        alone = measure.number(_figures(call, None))
        better = PolicyEnumeration([call], measure, [line]).better(alone)
        return measure.figures(alone if better is None else better[0])

    @cached_property
    def _idle(self) -> Figures:
        """The best with idle robots; it differs from the human's plans only if they are not optimal."""
        each = [_idle(call) for call in self._calls]
        return measured(self.result.options.risk, self.lines, each, self._floors)

    def _figures_fault(self) -> str | None:
        """What regret compares with, and what the human gains alone if their plans are not optimal."""
        result, lines = self.result, self.lines
        expected = figures(result, lines, self._floors)
        at_most = result.options.risk == "regret" and result.status == "feasible"
        fault = differing(result, expected, at_most=at_most)
        if fault is not None:
            return fault
        said, alone, idle = result.saving_alone, expected["human_cost"], self._idle[1]
        known = said is not None or result.status != "feasible"
        if known and not at_most and (said is None or not close(said, alone - idle)):
            return wording.EXPECTED_SAVING_ALONE.format(float(alone - idle), said)
        if result.opportunity and expected["cost"] >= idle:
            return wording.NO_CHEAPER.format(f"{float(idle):.12g}")
        return None

    # -- optima

    def _best(self) -> tuple[ClaimVerdict, str, Better | None]:
        """Whether a policy is better than the answer says."""
        weights, prices = [line.weight for line in self.lines], [line.prices for line in self.lines]
        measure = Measure(self._calls, weights, self._floors, prices)
        limit = self._limit(measure)
        if measure.joined(measure.floors) >= limit:
            return "proved", wording.EACH_ADDS_UP, None
        if self.effort.proof is not None:
            kept = any(line.original or line.prices or line.task.robot_goal for line in self.lines)
            if kept or self.effort.encoding != "automata":
                raise NoProgramError("policies under rules of help, or by the paper's equations")
            measure = Measure(self._calls, weights, self._floors, plain=True)
            refute_policies(self._calls, measure, self._limit(measure) - measure.slack)
            return "proved", wording.ALL_POLICIES, None
        better = PolicyEnumeration(self._calls, measure, self.lines).better(limit)
        if better is None:
            return "proved", wording.ALL_POLICIES, None
        objective, cost = measure.figures(better[0])
        if self.result.status == "optimal" and not self.result.opportunity and cost >= self._idle[1]:
            return "proved", wording.ALL_POLICIES, None
        return "refuted", wording.BETTER_POLICY.format(float(cost), float(objective)), better

    def _limit(self, measure: Measure) -> int:
        """What no policy is below, if the answer is right."""
        result = self.result
        assert result.lower_bound is not None, "a rule"
        if result.status != "optimal":
            bound = Fraction(result.lower_bound) * _ROUNDED
            if not result.opportunity and result.options.risk != "regret":  # net of an epoch of every window
                bound += result.options.window_weight
            return measure.bound(bound)
        if not result.opportunity:
            return measure.number(self._idle)
        return measure.number(answered(result, self.lines, self._floors))


def floor_of(call: ExaminedCall) -> Figures:
    """What the scenario by itself allows."""
    return _figures(call, best_plan(call) if call.human_plan else None)


def _idle(call: ExaminedCall) -> Figures:
    question = call.question.but(robots=False)
    return _figures(call, None if call.is_optimal else call.best(question, call.do_nothing))


def _figures(call: ExaminedCall, best: PricedPlan | None) -> Figures:
    """Of a plan, or of leaving the human alone, which counts as an epoch, whatever their plan's length."""
    assert call.baseline is not None, "only goals with a plan are considered"
    units = call.baseline + call.prices.epoch, call.baseline
    if best is not None:  # doing nothing is an answer beside whatever has to be kept
        units = min(units, (best.objective, best.cost))
    return call.prices.cost(units[0]), call.prices.cost(units[1])
