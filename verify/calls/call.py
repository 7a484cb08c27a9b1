"""One planning call as the verifier sees it: ``pi_H``, horizon, baseline, and its questions."""

from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

from serendipity.model import INFINITE, HumanPlan, Options, Task, UsageError
from serendipity.model.keywords import Horizon
from verify.base.optimal_plans import OptimalPlans
from verify.base.subproblem import EXACT, FREE, WINDOW, IntegerPrices, PricedPlan, Subproblem, prices
from verify.calls.methods import decide
from verify.exhaustive.by_epochs import cheapest_following
from verify.programs.effort import Effort

Score = tuple[int, int]
"""Objective and cost in units: the order of semantics 3.1 as far as it is proved."""


@dataclass(frozen=True)
class ExaminedCall:
    """A task, options and one human plan.

    Attributes:
        human_plan: ``pi_H``, or None where the human has no plan alone.
        free: the call without rules of help, where what these ask for stands among the robots' goals.
    """

    task: Task
    options: Options
    human_plan: HumanPlan | None
    plans: OptimalPlans
    effort: Effort = field(default_factory=Effort)
    free: "ExaminedCall | None" = None

    @cached_property
    def horizon(self) -> Horizon:
        """``T`` (semantics 2, 3.1, 3.5).

        Raises:
            UsageError: it is missing or shorter than ``pi_H``.
        """
        asked, plan = self.options.horizon, self.human_plan
        if asked is None:
            if plan is None and self.options.mode == "composite":
                return INFINITE
            open_goal = self.robots_goal and not self.task.robot_goal.holds(self.task.init)
            if plan is None or (not plan and open_goal):
                raise UsageError(
                    "horizon: expected a number of epochs: the human has no plan to take it from"
                )
            return len(plan)
        if plan is not None and asked != INFINITE and int(asked) < len(plan):
            raise UsageError(
                f"horizon: expected at least {len(plan)}, the length of the human's plan, got {asked}"
            )
        return asked

    @property
    def needs_pi_h(self) -> bool:
        """Whether there is no answer without a plan of the human's: nothing to preserve (semantics 3.5)."""
        return self.options.windowed or self.options.mode == "individual"

    @property
    def robots_goal(self) -> bool:
        """Whether robots have goals of their own."""
        return bool(self.task.robot_goal) and self.options.mode != "individual"

    @cached_property
    def prices(self) -> IntegerPrices:
        """Integer costs."""
        return prices(self.task, self.options, self.human_plan or (), self.effort.deadline)

    @cached_property
    def question(self) -> Subproblem:
        """All plans that the mode and its options allow.  The horizon has to be finite."""
        return self.endless.but(horizon=int(self.horizon))

    @cached_property
    def endless(self) -> Subproblem:
        """The same without a horizon."""
        return self._question(WINDOW if self.options.windowed else FREE).below(None, self._most_cost)

    def _question(self, rule: str) -> Subproblem:
        """A question without horizon and limits."""
        return Subproblem(
            task=self.task,
            options=self.options,
            rule=rule,
            human_plan=self.human_plan or (),
            horizon=0,
            prices=self.prices,
            deadline=self.effort.deadline,
        )

    @property
    def _most_cost(self) -> int | None:
        limit = self.options.max_cost
        if limit == "human":
            return self.baseline
        return None if limit is None else self.prices.units(Fraction(limit))

    @cached_property
    def baseline(self) -> int | None:
        """Cost of doing nothing for the human, in units; None if that is impossible (semantics 3.1, 3.5)."""
        if self.human_plan is None:
            return None
        if not self.robots_goal:
            return sum(self.prices.team[i] for i in self.human_plan)
        found = self.idle_robots_plan
        return None if found is None else found.cost

    @cached_property
    def idle_robots_plan(self) -> PricedPlan | None:
        """The cheapest plan in which the human executes ``pi_H`` and robots reach ``G_R`` by themselves."""
        if self.horizon == INFINITE:
            return cheapest_following(self._question(EXACT), self.plans).proved()
        question = self._question(EXACT).but(horizon=int(self.horizon))
        return decide(question, self.effort, self.plans).proved()

    @cached_property
    def do_nothing(self) -> Score | None:
        """Objective and cost of doing nothing for the human, which no limit rejects.

        ``pi_H`` with idle robots fits a window of one epoch.  None where it is no candidate: there is
        no ``pi_H``, or robots have goals, and may need all epochs for them, while a window is asked for.
        """
        if self.baseline is None or (self.robots_goal and self.options.windowed):
            return None
        epochs = 1 if self.options.windowed and self.human_plan else 0
        return self.baseline + epochs * self.prices.epoch, self.baseline

    @cached_property
    def idle(self) -> int | None:
        """Cost of the answer with all robots idle: less than the baseline only for a given ``pi_H``."""
        if self.free is not None and self.free.idle is not None:
            return self.prices.units(self.free.prices.cost(self.free.idle))
        if self.baseline is None or self.robots_goal or self.is_optimal:
            return self.baseline
        if self.horizon == INFINITE:
            worth = self.plans.alone.optimum(self.task.init)  # nobody has to wait for a head start
            assert worth is not None
            best, limit = self.prices.units(worth[0]), self._most_cost
            return best if limit is None or best <= limit else self.baseline
        found = self.best(self.question.but(robots=False), self.do_nothing)
        return self.baseline if found is None else found.cost

    @cached_property
    def is_optimal(self) -> bool:
        """Whether ``pi_H`` costs no more than the human's optimal plan."""
        worth, plan = self.plans.alone.predicted(), self.human_plan
        return worth is not None and plan is not None and worth[0] == self.task.cost_of(plan)

    def better(self, question: Subproblem, than: Score) -> PricedPlan | None:
        """Some plan with a lower score; None: proved that there is none."""
        objective, cost = than
        limits = [question.below(objective - 1)]
        if self.may_tie(than):
            limits.append(question.below(objective, cost - 1))
        for limited in limits:
            found = decide(limited, self.effort, self.plans).settled()
            if found is not None:
                return found
        return None

    def best(self, question: Subproblem, than: Score | None) -> PricedPlan | None:
        """The plan of least objective, then cost, among those with a lower score than ``than``."""
        limited = question if than is None else question.below(than[0] - 1)
        best = decide(limited, self.effort, self.plans).proved()
        score = than if best is None else (best.objective, best.cost)
        while score is not None and self.may_tie(score):
            tie = question.below(score[0], score[1] - 1)
            found = decide(tie, self.effort, self.plans).proved()
            if found is None:
                break
            best, score = found, (found.objective, found.cost)
        return best

    def may_tie(self, score: Score) -> bool:
        """Whether another plan could have the same objective at a lower cost.

        It would pay for it with communication, or with at least ``K`` for a longer window.
        """
        cost = score[1]
        return cost > 0 and (any(self.prices.talk) or 0 < self.prices.epoch <= cost)
