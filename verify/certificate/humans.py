"""Claims about the best help that happens with a human who replans (semantics 6)."""

from fractions import Fraction
from functools import cached_property

from verify.base import wording
from verify.base.subproblem import Solution
from verify.base.undecided import UndecidedError
from verify.calls.call import Call
from verify.certificate.claims import Examiner, Verdict
from verify.certificate.reactions import cheapest_reaction
from verify.simulator import Person, play


class HumanExaminer(Examiner):
    """Examines a result that was planned for an observant or a local human.

    No integer program knows what they do; whatever robots could do is played instead.
    """

    def optimal(self) -> Verdict:
        """Nothing that happens with the human costs less."""
        cost = self._score()[1]
        found = _cheaper(self.call, cost)
        if found is not None:
            return "refuted", wording.BETTER, found
        return "proved", self._played(cost), None

    def no_opportunity(self) -> Verdict:
        """Nothing that happens with the human costs less than without robots."""
        cost = self._score()[1] if self.call.robots_goal else self._alone
        assert cost is not None, "without goals of the robots, leaving him alone is an answer"
        found = _cheaper(self.call, cost)
        if found is not None:
            return "refuted", wording.BETTER if self.call.robots_goal else wording.OPPORTUNITY, found
        if self.call.robots_goal and (self._alone is None or cost < self._alone):
            return "refuted", wording.LEFT_ALONE_IS_DEARER, None
        return "proved", self._played(cost), None

    def opportunity_is_cheaper(self) -> Verdict | None:
        """Refutes an opportunity that costs no less than doing without robots."""
        if self._alone is not None and self._score()[1] >= self._alone:
            return "refuted", wording.no_cheaper(self._amount(self._alone)), None
        return None

    def savings(self) -> Verdict | None:
        """Refutes ``saving`` and ``saving_alone``."""
        call, result = self.call, self.result
        if call.baseline is None:
            return self._nothing_to_compare()
        if result.plan is None:
            return None
        compared = self._idle is not None and not call.robots_goal
        idle = min(self._idle, call.baseline) if compared and self._idle is not None else call.baseline
        alone = float(call.prices.cost(call.baseline - idle))
        if result.saving_alone != alone and not self._not_yet_known():
            return "refuted", wording.figure("saving_alone", alone, result.saving_alone), None
        saving = float(call.prices.cost(call.baseline - self._score()[1])) if result.opportunity else 0.0
        if result.saving != saving:
            return "refuted", wording.figure("saving", saving, result.saving), None
        return None

    def lower_bound(self) -> Verdict:
        """Nothing that happens with the human, and no answer, costs less than the bound."""
        bound = self.result.lower_bound
        assert bound is not None
        least = self._units_at_least(bound)
        if not self.call.robots_goal and self._alone is not None and self._alone < least:
            return "refuted", wording.without_robots(self._amount(self._alone)), None
        found = _cheaper(self.call, least)
        if found is not None:
            return "refuted", wording.BELOW_BOUND, found
        return "proved", self._played(least), None

    def infeasible(self) -> Verdict:
        """The human has no plan alone, or nothing that happens reaches the robots' goals."""
        call = self.call
        if call.human_plan is None:
            return super().infeasible()
        found = _decided(call, None)
        if found is not None:
            return "refuted", wording.PLAN, found
        return "proved", wording.ALL_PLAYED, None

    @cached_property
    def _alone(self) -> int | None:
        """What it costs without help: ``pi_H``, or what the human does alone if that is less."""
        costs = [cost for cost in (self.call.baseline, self._idle) if cost is not None]
        return min(costs, default=None)

    @cached_property
    def _idle(self) -> int | None:
        return _idle_cost(self.call)

    def _played(self, cost: int) -> str:
        return wording.all_played(self._amount(cost))


def human_cost(call: Call) -> Fraction | None:
    """Cost of the answer to a call under its human model; None: infeasible.

    Raises:
        UndecidedError: it could not be proved.
        TooManyStatesError: the human's own problem is too large.
    """
    if call.human_plan is None:
        return None
    if call.robots_goal:
        found = _decided(call, None)
        return None if found is None else call.prices.cost(found.cost)
    assert call.baseline is not None
    idle = _idle_cost(call)
    found = _cheaper(call, call.baseline if idle is None else min(idle, call.baseline))
    return call.prices.cost(call.baseline if found is None else found.cost)


def _cheaper(call: Call, cost: int) -> Solution | None:
    return _decided(call, cost - 1)


def _decided(call: Call, most: int | None) -> Solution | None:
    minimum = cheapest_reaction(call, most)
    if minimum.status == "undecided":
        raise UndecidedError(minimum.reason)
    return minimum.found


def _idle_cost(call: Call) -> int | None:
    """What the human pays alone; None if that does not reach all goals in time."""
    if call.human_plan is None:
        return None
    horizon = call.horizon
    played = play(
        call.task,
        call.options,
        call.human_plan,
        (),
        human_model=call.options.human_model,
        horizon=horizon if isinstance(horizon, int) else None,
        person=Person(call.task, call.plans),
    )
    return call.prices.units(played.cost) if played.goals_hold else None
