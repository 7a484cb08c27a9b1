"""What every search of one call shares: packed task, key weights, bounds, the human alone."""

from functools import cached_property

from search.heuristics.interactions import Interactions
from search.heuristics.private_distances import PrivateDistances
from search.human.individual_planner import IndividualPlanner, PlanGraph, PricedPlanner
from search.human.pattern_database import PatternDatabase, human_projection, human_steps
from search.packed.cost_vector import Weights
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal, PackedTask, human_facts, pack, pack_fully
from search.packed.successor_generator import JointAction, Successors, as_option
from search.robots.decoupled import Decoupled, DecoupledSuccessors
from serendipity.model.actions import Condition
from serendipity.model.deadline import Deadline
from serendipity.model.options import Options
from serendipity.model.task import HumanPlan, Task


class SearchContext:
    """Tables of one call.

    Args:
        task: the task.
        options: options in force.
        deadline: asked for time while tables are built.
        plan: ``pi_H`` where it is known; None while it is being predicted.
    """

    def __init__(
        self, task: Task, options: Options, deadline: Deadline, plan: HumanPlan | None = None
    ) -> None:
        self.task = task
        self.options = options
        self.deadline = deadline
        packing = pack_fully if options.preservation == "state" else pack
        self.packed = packing(task, deadline)
        if plan is not None and not self._covers(plan):
            needed = {f for i in plan for f in (*task.actions[i].pre, *task.actions[i].neg)}
            extra = human_facts(task) if options.preservation == "state" else frozenset()
            self.packed = PackedTask(task, extra | needed, deadline)
        self.weights = Weights(self.packed, options, plan)
        self.keys = self.weights.keys

    def for_plan(self, plan: HumanPlan) -> "SearchContext":
        """Tables in which ``pi_H`` is known; these ones, where that makes no difference."""
        announces = self.options.mode == "communication" and self.options.communication_weight > 0
        if announces or not self._covers(plan):
            return SearchContext(self.task, self.options, self.deadline, plan)
        return self

    def _covers(self, plan: HumanPlan) -> bool:
        """Whether the encoding packs what every action of a plan asks for."""
        bits = self.packed.fact_bits
        actions = (self.task.actions[i] for i in plan)
        return all(bits[f] is not None for action in actions for f in (*action.pre, *action.neg))

    @cached_property
    def bound(self) -> PatternDatabase:
        """Lower bound on what the human still has to pay for ``G_H``."""
        return human_projection(self.packed, self.weights, self.deadline)

    @property
    def steps(self) -> PatternDatabase:
        """Lower bound on the number of his actions to ``G_H``."""
        return self.packed.derived(human_steps, self.deadline)

    @cached_property
    def alone(self) -> IndividualPlanner | PricedPlanner:
        """The human by himself, to ``G_H``."""
        if not self.weights.announces:
            return PricedPlanner(self.packed, self.weights, self.deadline)
        return IndividualPlanner(self.packed, self.packed.goal, self.weights.alone, self.bound, self.deadline)

    @cached_property
    def alone_to_both(self) -> IndividualPlanner | None:
        """The human by himself, to ``G_H`` and ``G_R``; None where he can't affect ``G_R``."""
        robot_goal = self.task.robot_goal
        touched = {*robot_goal.positive, *robot_goal.negative}
        affects = bool(touched) and any(
            touched.intersection(action.add) or touched.intersection(action.delete)
            for action in (self.task.actions[i] for i in self.task.human_actions)
        )
        if not affects:
            return None
        goal = self.packed.condition(_both(self.task))
        return IndividualPlanner(self.packed, goal, self.weights.alone, self.bound, self.deadline)

    @property
    def interactions(self) -> Interactions:
        """What the human's ops mention."""
        return self.packed.derived(Interactions, self.deadline)

    @cached_property
    def ways(self) -> PrivateDistances:
        """The human's ways to his touches."""
        return PrivateDistances(
            self.packed, self.interactions, self.bound, self.steps, self.weights, self.deadline
        )

    def successors(self, *, idle: bool = False) -> Successors:
        """Action sets under the interference rule; with ``idle`` robots do nothing."""
        return Successors(
            self.packed, self.weights.team, self.deadline, strict=self.options.strict, idle=idle
        )

    def walks(self, plan: HumanPlan) -> Decoupled | None:
        """Robots' walks where they can be folded, and it pays: with several robots."""
        if len(self.task.robots) < 2 or self.options.preservation == "state":
            return None
        walks = self.packed.derived(Decoupled, self.deadline)
        if not walks.foldable or walks.touched_by(map(self.packed.op, plan)):
            return None
        return walks

    def folded(self, walks: Decoupled) -> DecoupledSuccessors:
        """:meth:`successors` with walks left out."""
        return DecoupledSuccessors(
            self.packed, walks, self.weights.team, self.deadline, strict=self.options.strict
        )

    @property
    def goals(self) -> tuple[PackedGoal, ...]:
        """``G_H`` and ``G_R``, packed."""
        return self.packed.goal, self.packed.robot_goal

    def optimal_plans(self) -> PlanGraph | None:
        """The human's optimal plans from ``I``, or None where he has none."""
        return self.alone.plans(self.packed.init)

    @cached_property
    def _followed(self) -> dict[HumanPlan, list[tuple[Operator, JointAction]]]:
        return {}

    def followed(self, plan: HumanPlan) -> list[tuple[Operator, JointAction]]:
        """The packed actions of a human plan and what they do, in order."""
        known = self._followed.get(plan)
        if known is None:
            ops = [self.packed.op(i) for i in plan]
            known = self._followed[plan] = [(op, as_option(op, self.weights.team(op))) for op in ops]
        return known


def _both(task: Task) -> Condition:
    return Condition(
        tuple(sorted({*task.goal.positive, *task.robot_goal.positive})),
        tuple(sorted({*task.goal.negative, *task.robot_goal.negative})),
    )
