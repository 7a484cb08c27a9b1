"""Claims about the best help that happens with a human who replans (semantics 6)."""

from dataclasses import replace
from fractions import Fraction
from functools import cached_property

from verify.base import wording
from verify.base.subproblem import FREE, PricedPlan
from verify.calls.call import ExaminedCall
from verify.calls.methods import JOINT_PLANS, decide
from verify.certificate.claims import Examiner, Verdict
from verify.certificate.reactions import cheapest_reaction
from verify.certificate.simulator import play
from verify.limits import uses
from verify.programs.effort import NoProgramError


class HumanExaminer(Examiner):
    """Examines a result that was planned for an observant or a local human.

    No integer program knows what they do.  One says what the team could do if they did anything; where that
    is not enough, whatever robots could do is played.
    """

    def optimal(self) -> Verdict:
        """Nothing that happens with the human costs less."""
        return self._none_for_less(self._score()[1], wording.BETTER)

    def no_opportunity(self) -> Verdict:
        """Nothing that happens with the human costs less than without robots."""
        cost = self._score()[1] if self.call.robots_goal else self._alone
        assert cost is not None, "without goals of the robots, leaving him alone is an answer"
        found = self._none_for_less(cost, wording.BETTER if self.call.robots_goal else wording.OPPORTUNITY)
        dearer = self.call.robots_goal and (self._alone is None or cost < self._alone)
        return ("refuted", wording.LEFT_ALONE_IS_DEARER, None) if dearer and found[2] is None else found

    def opportunity_is_cheaper(self) -> Verdict | None:
        """Refutes an opportunity that costs no less than doing without robots."""
        if self._alone is not None and self._score()[1] >= self._alone:
            return "refuted", wording.NO_CHEAPER.format(self._amount(self._alone)), None
        return None

    def _saved(self, baseline: int) -> Verdict | None:
        """See :class:`Examiner`."""
        idle = baseline if self.call.robots_goal or self._alone is None else self._alone
        return self._wrong_savings(baseline, idle)

    def lower_bound(self) -> Verdict:
        """Nothing that happens with the human, and no answer, costs less than the bound."""
        bound = self.result.lower_bound
        assert bound is not None
        least = self._units_at_least(bound)
        if not self.call.robots_goal and self._alone is not None and self._alone < least:
            return "refuted", wording.WITHOUT_ROBOTS.format(self._amount(self._alone)), None
        return self._none_for_less(least, wording.BELOW_BOUND)

    def infeasible(self) -> Verdict:
        """The human has no plan alone, or nothing that happens reaches the robots' goals."""
        call = self.call
        if call.human_plan is None:
            return super().infeasible()
        found = _cheaper(call, None)
        if found is not None:
            return "refuted", wording.PLAN, found
        return "proved", wording.ALL_PLAYED, None

    @cached_property
    def _alone(self) -> int | None:
        """What it costs without help: ``pi_H``, or what the human does alone if that is less."""
        return _without_help(self.call)

    def _none_for_less(self, cost: int, refuted: str) -> Verdict:
        found = _cheaper(self.call, cost)
        if found is not None:
            return "refuted", refuted, found
        made = self.call.effort.attempts
        played = bool(made) and made[-1].method == "exhaustive"
        words = wording.ALL_CHEAPER_PLAYED if played else wording.WHATEVER_HAPPENS
        return "proved", words.format(self._amount(cost)), None


def human_cost(call: ExaminedCall) -> Fraction | None:
    """Cost of the answer to a call under its human model; None: infeasible."""
    if call.human_plan is None:
        return None
    if call.robots_goal:
        found = _cheaper(call, None)
        return None if found is None else call.prices.cost(found.cost)
    assert call.baseline is not None
    found = _cheaper(call, _without_help(call))
    return call.prices.cost(call.baseline if found is None else found.cost)


def _cheaper(call: ExaminedCall, cost: int | None) -> PricedPlan | None:
    """The cheapest that happens with the human, for less than so much; None: proved that there is nothing.

    Raises:
        NoProgramError: a proof file is asked for, and a plan that costs no more has to be played.
    """
    most = None if cost is None else cost - 1
    if _out_of_reach(call, most):
        return None
    if call.effort.proof is not None:
        raise NoProgramError("a human who replans, where a joint plan costs less than the answer")
    return cheapest_reaction(call, most).proved()


def _out_of_reach(call: ExaminedCall, most: int | None) -> bool:
    """Whether a program says that no joint plan costs so little: then nothing that happens does.

    Whatever robots do beside a human who replans, what is executed is a plan of the team.  ``exhaustive``
    asks no program, and in turns it gets a moment.
    """
    effort = call.effort
    question = call.question.but(rule=FREE).below(most)
    if effort.method == "exhaustive" or not uses(JOINT_PLANS.name):
        return False
    if effort.method == "auto":
        effort = replace(effort, method="pruned", deadline=JOINT_PLANS.turn(effort.deadline))
        question = question.but(deadline=effort.deadline)
    return decide(question, effort, call.plans).status == "none"


def _without_help(call: ExaminedCall) -> int | None:
    """The cost of ``pi_H``, or of what the human does alone, if that reaches all goals in time."""
    costs = [] if call.baseline is None else [call.baseline]
    if call.human_plan is not None:
        human, plans = call.options.human_model, call.plans
        played = play(
            call.task, call.options, call.human_plan, (), human_model=human, horizon=call.horizon, plans=plans
        )
        costs += [call.prices.units(played.cost)] if played.goals_hold else []
    return min(costs, default=None)
