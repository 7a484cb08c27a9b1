"""The integer program as a planner: the whole answer to a call (semantics 3)."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from serendipity.model import INFINITE, HumanPlan, Options, Task
from verify.base.obligations import TIED_MODES
from verify.base.optimal_plans import OptimalPlans
from verify.base.plan_graph import OptimalPlanGraph
from verify.base.subproblem import PricedPlan
from verify.calls.call import ExaminedCall, Score
from verify.calls.methods import decide_without_horizon
from verify.programs.effort import Effort


@dataclass(frozen=True, slots=True)
class CallAnswer:
    """What a call is answered, proved; costs in the call's units.

    Attributes:
        found: the plan of least objective, or None where ``pi_H`` (or nothing) is the answer.
    """

    call: ExaminedCall
    found: PricedPlan | None
    opportunity: bool

    @property
    def cost(self) -> Fraction | None:
        """The answer's cost; None: infeasible."""
        units = self.call.baseline if self.found is None else self.found.cost
        return None if units is None else self.call.prices.cost(units)

    @property
    def objective(self) -> Fraction | None:
        """The answer's objective; that of doing nothing has no ``K``."""
        return self.cost if self.found is None else self.call.prices.cost(self.found.objective)

    @property
    def saving(self) -> Fraction | None:
        """What an opportunity costs less than doing nothing, else 0; None where that is no answer."""
        if self.cost is None or self.call.baseline is None:
            return None
        return self.call.prices.cost(self.call.baseline) - self.cost if self.opportunity else Fraction(0)


def answer(call: ExaminedCall) -> CallAnswer:
    """Solve a call.

    Raises:
        UsageError: the call needs a horizon.
    """
    if call.options.mode == "individual" or (call.needs_pi_h and call.human_plan is None):
        return CallAnswer(call, None, opportunity=False)
    found = best_plan(call)
    helps = found is not None and is_help(call, (found.objective, found.cost))
    if call.options.windowed and not helps:
        found = None
    return CallAnswer(call, found, opportunity=helps and call.human_plan is not None)


def best_plan(call: ExaminedCall, *, robots: bool = True) -> PricedPlan | None:
    """The plan of least objective, then cost, if it beats doing nothing; without ``robots`` none acts."""
    if call.horizon != INFINITE:
        return call.best(call.question.but(robots=robots), call.do_nothing)
    question = call.endless.but(robots=robots)
    if call.do_nothing is not None:
        question = question.below(call.do_nothing[0] - 1)
    return decide_without_horizon(question, call.effort, call.plans).proved()


def is_help(call: ExaminedCall, score: Score) -> bool:
    """Whether a plan of this objective and cost beats what there is without robots (semantics 1, 3.1)."""
    idle, alone = call.idle, unaided(call)
    return (idle is None or score[1] < idle) and (alone is None or score < alone)


def unaided(call: ExaminedCall) -> Score | None:
    """Objective and cost of the best plan in which no robot acts, where help has to beat that, too.

    It has where robots have goals and a plan is given that is not optimal.  Without such goals
    ``call.idle`` is that plan's; beside an optimal plan whatever costs less is an opportunity.
    """
    if call.human_plan is None or not call.robots_goal or call.is_optimal:
        return None
    found = best_plan(call, robots=False)
    return None if found is None else (found.objective, found.cost)


def calls(
    task: Task, options: Options, given: HumanPlan | None, effort: Effort, plans: OptimalPlans
) -> Sequence[ExaminedCall]:
    """The calls that make up a task: one, or one for each optimal ``pi_H`` under ``ties``.

    Args:
        given: ``pi_H`` by ids, or None to predict it.

    Raises:
        UsageError: there are more than ``max_ties``.
    """
    if given is not None and options.mode != "individual":
        return [ExaminedCall(task, options, given, plans, effort)]
    if options.ties == "fixed" or options.mode not in TIED_MODES:
        return [ExaminedCall(task, options, plans.canonical(), plans, effort)]
    tied: list[HumanPlan | None] = [*OptimalPlanGraph(task, plans, options.max_ties).plans()]
    return [ExaminedCall(task, options, plan, plans, effort) for plan in tied or [None]]
