"""Proofs that robots can do no better for several goals than an answer says (semantics 8)."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from time import perf_counter

from serendipity.model import Claim, Result
from serendipity.model.answers.certificate import ClaimVerdict
from verify.base import wording
from verify.base.execution import plan_step
from verify.base.optimal_plans import OptimalPlans
from verify.base.undecided import UNDECIDED, why
from verify.calls.call import ExaminedCall
from verify.goals.check import beyond_rules
from verify.goals.timelines import GoalTimeline, close, mean
from verify.goals.together import AllGoals, Better, Rank
from verify.programs.effort import Effort, NoProgramError

_ROUNDED = 1 - Fraction(1, 10**9)
"""A bound that was summed from rounded probabilities may be too high by its last digits."""


class GoalsProof:
    """The claims about an answer for several goals that need an optimiser.

    Args:
        result: an answer that breaks no rule.
        lines: its timelines.
        effort: the solver's settings.
    """

    def __init__(self, result: Result, lines: Sequence[GoalTimeline], effort: Effort) -> None:
        self.result = result
        self.lines = lines
        self.effort = effort

    def claims(self) -> Iterator[Claim]:
        """What rules can't say: one proof for the optimum and its bound."""
        started, mark = perf_counter(), self.effort.mark
        first, *others = beyond_rules(self.result)
        better: Better | None = None
        try:
            together = self._together()
            idle = together.idle()
            fault = self._idle_fault(idle[1])
            if fault is not None:
                yield Claim("cost", "refuted", fault, seconds=perf_counter() - started)
                return
            verdict, reason, better = self._best(together, idle)
        except UNDECIDED as error:
            verdict, reason = "undecided", why(error)
        bound = self.result.lower_bound if verdict == "proved" else None
        task, discount = self.lines[0].task, self.result.options.discount
        example = None if better is None else tuple(plan_step(task, s, discount) for s in better.robots)
        spent = self.effort.since(mark)
        yield Claim(first, verdict, reason, example, perf_counter() - started, bound, *spent)
        for name in others:
            yield Claim(name, verdict, wording.LIKE.format(first, reason), example, 0.0, bound, *spent)

    def _best(self, together: AllGoals, idle: Rank) -> tuple[ClaimVerdict, str, Better | None]:
        """Whether robots could do better than the answer says they can."""
        limit = self._limit(idle)
        if together.floor() >= limit:
            return "proved", wording.EACH_ADDS_UP, None
        if self.effort.proof is not None:
            raise NoProgramError("several goals whose best answers by themselves don't add up to the answer")
        better = together.better(limit)
        denied = self.result.status == "optimal" and not self.result.opportunity
        if better is None or (denied and better.rank[1] >= idle[1]):
            return "proved", wording.ALL_PLAYED_FOR_ALL, None
        objective, cost = map(float, better.rank)
        return "refuted", wording.BETTER_FOR_ALL.format(cost, objective), better

    def _limit(self, idle: Rank) -> Rank:
        """What no robots' plan ranks before, if the answer is right."""
        result, window = self.result, self.result.options.window_weight
        assert result.lower_bound is not None, "a rule"
        if result.status != "optimal":  # without an opportunity it is net of the one epoch of every window
            epochs = 0 if result.opportunity else 1
            return Fraction(result.lower_bound) * _ROUNDED + window * epochs, Fraction(-1)
        if not result.opportunity:
            return idle
        cost = mean(self.lines, [line.case.cost for line in self.lines])
        return cost + window * mean(self.lines, [Fraction(line.epochs) for line in self.lines]), cost

    def _together(self) -> AllGoals:
        options = self.result.options.but(horizon=self.result.horizon, time_limit=None)
        calls = []
        for line in self.lines:
            plans = OptimalPlans(line.task, line.case.alone)
            calls.append(ExaminedCall(line.task, options, line.case.pi_h, plans, self.effort))
        return AllGoals(calls, [line.weight for line in self.lines])

    def _idle_fault(self, idle: Fraction) -> str | None:
        """What the human gains alone, where observations make their plans dearer than need be."""
        said, alone = self.result.saving_alone, mean(self.lines, [line.alone for line in self.lines])
        if said is None or not close(said, alone - idle):
            return wording.EXPECTED_SAVING_ALONE.format(float(alone - idle), said)
        if self.result.opportunity and mean(self.lines, [line.case.cost for line in self.lines]) >= idle:
            return wording.NO_CHEAPER.format(f"{float(idle):.12g}")
        return None
