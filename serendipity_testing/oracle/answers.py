"""The optimum of a call, in every mode (semantics 3, 10)."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from serendipity.model import HumanPlan, Options, Task, TimedPlan, Window
from serendipity_testing.oracle.labels import Label
from serendipity_testing.oracle.nobody_pays import is_ruled, unruled
from serendipity_testing.oracle.plans import Plans, WindowPlan


@dataclass(frozen=True, slots=True)
class Optimum:
    """The answer of an exact planner; costs as in ``Result``, but exact.

    ``actions`` counts the plan's actions; None where the answer is a mean over ties.
    """

    status: str
    cost: Fraction | None = None
    objective: Fraction | None = None
    window: Window | None = None
    actions: int | None = None
    opportunity: bool = False
    human_cost: Fraction | None = None
    saving: Fraction | None = None
    saving_alone: Fraction | None = None
    reason: str | None = None


class Solver:
    """One call with one ``pi_H`` (None: the human has no plan alone).

    Args:
        task: the task.
        options: in force.
        human_plan: ``pi_H``.
        given: whether it is given.
        unit: how many units a cost of 1 has; None: as few as do.

    Raises:
        PlanError: ``pi_H`` can't be done beside the script.
        UsageError: the horizon is missing or too short, or what ``pi_H`` reaches does not last so long.
    """

    def __init__(
        self,
        task: Task,
        options: Options,
        human_plan: HumanPlan | None,
        *,
        given: bool,
        unit: int | None = None,
    ) -> None:
        self.task = task
        self.options = options
        self.human_plan = human_plan
        self.given = given
        self.plans = Plans(task, options, human_plan, unit)

    def solve(self) -> Optimum:
        """The optimum."""
        if self.options.mode == "individual":
            return self._individual()
        if self.human_plan is None and self.options.mode == "serendipity":
            return Optimum("infeasible", reason="no-human-plan")
        baseline = self._baseline()
        found = min(self._candidates(baseline), key=WindowPlan.order, default=None)
        helps = found is not None and self._helps(found, baseline)
        return self._answer(found, baseline, helps=helps)

    # -- what is compared

    def _candidates(self, baseline: Label | None) -> Iterator[WindowPlan]:
        yield from self._limited(baseline)
        if baseline is not None and not (self.plans.robots_goal and self.options.windowed):
            yield self._do_nothing(baseline)

    def _limited(self, baseline: Label | None) -> Iterator[WindowPlan]:
        """All plans within ``max_cost``."""
        limit = self._max_cost(baseline)
        for candidate in self.plans.windows() if self.options.windowed else self.plans.whole():
            if limit is None or candidate.label[1] <= limit:
                yield candidate

    def _do_nothing(self, baseline: Label) -> WindowPlan:
        """The baseline: no limit rejects it, and with idle robots it fits the window of its last action."""
        assert self.human_plan is not None
        if not self.options.windowed or not self.plans.length:
            return WindowPlan(baseline, baseline[1], None)
        window = Window(self.plans.length, self.plans.length + 1)
        return WindowPlan(baseline, baseline[1] + self.plans.units(self.options.window_weight), window)

    def _baseline(self) -> Label | None:
        """The cost of doing nothing: ``pi_H`` alone, or with robots that reach ``G_R`` (semantics 3.1)."""
        plan = self.human_plan
        if plan is None:
            return None
        if not self.plans.robots_goal:
            cost = self.plans.units(self.plans.cost_of_plan())
            return (cost, cost, len(plan), 0, 0)
        return min(self.plans.beside_plan(), key=lambda label: label[1:], default=None)

    def _helps(self, found: WindowPlan, baseline: Label | None) -> bool:
        """Whether it is an opportunity (semantics 1, 3.1): cheaper than without robots."""
        if self.human_plan is None:
            return False
        idle = self._idle(baseline)
        if idle is not None and found.label[1] >= idle:
            return False
        ruled = is_ruled(self.task, self.options)
        if not self.improvable or not (ruled or self.plans.robots_goal):
            return True
        alone = min(self._without_robots(self.options)._limited(baseline), key=WindowPlan.order, default=None)
        if alone is not None and (found.objective, found.label[1]) >= (alone.objective, alone.label[1]):
            return False
        return not ruled or self.plans.robots_goal or self._helps_unruled()

    def _helps_unruled(self) -> bool:
        """Whether there is an opportunity without the rules of help: else leaving them alone keeps those."""
        options, plan = unruled(self.options), self.human_plan
        return Solver(self.task, options, plan, given=self.given, unit=self.plans.unit).solve().opportunity

    def _idle(self, baseline: Label | None) -> int | None:
        """Cost of the answer with all robots idle: less than the baseline if a given plan can be improved."""
        if baseline is None or self.plans.robots_goal or not self.improvable:
            return None if baseline is None else baseline[1]
        found = min(self._without_robots(unruled(self.options))._candidates(baseline), key=WindowPlan.order)
        return found.label[1]

    @property
    def improvable(self) -> bool:
        """Whether a plan is given that costs more than an optimal one."""
        worth = self.plans.optimum_alone()
        return self.given and worth is not None and worth[0] < self.plans.cost_of_plan()

    def _without_robots(self, options: Options) -> "Solver":
        """The same call, were there no robots, with the rules of help or without them."""
        own = self.task.human_actions
        task = replace(self.task, actions=tuple(self.task.actions[i] for i in own))
        given = self.human_plan or ()
        plan: HumanPlan = tuple(own.index(i) for i in given)
        if isinstance(given, TimedPlan):
            plan = TimedPlan(plan, given.starts, given.length)
        return Solver(task, options, plan, given=False, unit=self.plans.unit)

    def _max_cost(self, baseline: Label | None) -> int | None:
        limit = self.options.max_cost
        if limit == "human":
            return None if baseline is None else baseline[1]
        assert not isinstance(limit, str)
        return None if limit is None else self.plans.units(limit)

    # -- answers

    def _individual(self) -> Optimum:
        worth = self.plans.optimum_alone()
        if worth is None:
            return Optimum("infeasible", reason="no-human-plan")
        cost, length = worth
        human_cost = self.plans.cost_of_plan()
        return Optimum(
            "optimal",
            cost,
            cost,
            None,
            length,
            human_cost=human_cost,
            saving=Fraction(0),
            saving_alone=human_cost - cost,
        )

    def _answer(self, found: WindowPlan | None, baseline: Label | None, *, helps: bool) -> Optimum:
        human_cost = None if self.human_plan is None else self.plans.cost_of_plan()
        known = Optimum("optimal", human_cost=human_cost)
        if baseline is not None:
            idle = self._idle(baseline)
            assert idle is not None
            known = replace(known, saving=Fraction(0), saving_alone=self.plans.cost(baseline[1] - idle))
        if found is not None and (helps or not self.options.windowed):
            _, spent, actions, *_ = found.label
            saving = None if baseline is None else self.plans.cost(baseline[1] - spent if helps else 0)
            return replace(
                known,
                cost=self.plans.cost(spent),
                objective=self.plans.cost(found.objective),
                window=found.window,
                actions=actions,
                opportunity=helps,
                saving=saving,
            )
        if baseline is None:
            return replace(known, status="infeasible")
        cost = self.plans.cost(baseline[1])
        return replace(known, cost=cost, objective=cost, actions=baseline[2])
