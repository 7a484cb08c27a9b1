"""What every search of one call shares: packed task, key weights, bounds, the human alone."""

from functools import cached_property

from search.heuristics.interactions import Touches
from search.heuristics.private_distances import Ways
from search.human.individual_planner import Alone, PlanGraph, Priced
from search.human.pattern_database import Projection, human_projection, human_steps
from search.packed.cost_vector import Weights
from search.packed.operators import Op
from search.packed.packed_task import Encoding, Goal, encoding, full_encoding, human_facts
from search.packed.successor_generator import Option, Successors, as_option
from search.robots.decoupled import FoldedSuccessors, Walks
from serendipity.model.actions import Condition
from serendipity.model.deadline import Deadline
from serendipity.model.options import Options
from serendipity.model.task import HumanPlan, Task


class Tables:
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
        packing = full_encoding if options.preservation == "state" else encoding
        self.encoding = packing(task, deadline)
        if plan is not None and not self._covers(plan):
            needed = {f for i in plan for f in (*task.actions[i].pre, *task.actions[i].neg)}
            extra = human_facts(task) if options.preservation == "state" else frozenset()
            self.encoding = Encoding(task, extra | needed, deadline)
        self.weights = Weights(self.encoding, options, plan)
        self.keys = self.weights.keys

    def for_plan(self, plan: HumanPlan) -> "Tables":
        """Tables in which ``pi_H`` is known; these ones, where that makes no difference."""
        announces = self.options.mode == "communication" and self.options.communication_weight > 0
        if announces or not self._covers(plan):
            return Tables(self.task, self.options, self.deadline, plan)
        return self

    def _covers(self, plan: HumanPlan) -> bool:
        """Whether the encoding packs what every action of a plan asks for."""
        bits = self.encoding.fact_bits
        actions = (self.task.actions[i] for i in plan)
        return all(bits[f] is not None for action in actions for f in (*action.pre, *action.neg))

    @cached_property
    def bound(self) -> Projection:
        """Lower bound on what the human still has to pay for ``G_H``."""
        return human_projection(self.encoding, self.weights, self.deadline)

    @property
    def steps(self) -> Projection:
        """Lower bound on the number of his actions to ``G_H``."""
        return self.encoding.derived(human_steps, self.deadline)

    @cached_property
    def alone(self) -> Alone | Priced:
        """The human by himself, to ``G_H``."""
        if not self.weights.announces:
            return Priced(self.encoding, self.weights, self.deadline)
        return Alone(self.encoding, self.encoding.goal, self.weights.alone, self.bound, self.deadline)

    @cached_property
    def alone_to_both(self) -> Alone | None:
        """The human by himself, to ``G_H`` and ``G_R``; None where he can't affect ``G_R``."""
        robot_goal = self.task.robot_goal
        touched = {*robot_goal.positive, *robot_goal.negative}
        affects = bool(touched) and any(
            touched.intersection(action.add) or touched.intersection(action.delete)
            for action in (self.task.actions[i] for i in self.task.human_actions)
        )
        if not affects:
            return None
        goal = self.encoding.condition(_both(self.task))
        return Alone(self.encoding, goal, self.weights.alone, self.bound, self.deadline)

    @property
    def touches(self) -> Touches:
        """What the human's ops mention."""
        return self.encoding.derived(Touches, self.deadline)

    @cached_property
    def ways(self) -> Ways:
        """The human's ways to his touches."""
        return Ways(self.encoding, self.touches, self.bound, self.steps, self.weights, self.deadline)

    def successors(self, *, idle: bool = False) -> Successors:
        """Action sets under the interference rule; with ``idle`` robots do nothing."""
        return Successors(
            self.encoding, self.weights.team, self.deadline, strict=self.options.strict, idle=idle
        )

    def walks(self, plan: HumanPlan) -> Walks | None:
        """Robots' walks where they can be folded, and it pays: with several robots."""
        if len(self.task.robots) < 2 or self.options.preservation == "state":
            return None
        walks = self.encoding.derived(Walks, self.deadline)
        if not walks.foldable or walks.touched_by(map(self.encoding.op, plan)):
            return None
        return walks

    def folded(self, walks: Walks) -> FoldedSuccessors:
        """:meth:`successors` with walks left out."""
        return FoldedSuccessors(
            self.encoding, walks, self.weights.team, self.deadline, strict=self.options.strict
        )

    @property
    def goals(self) -> tuple[Goal, ...]:
        """``G_H`` and ``G_R``, packed."""
        return self.encoding.goal, self.encoding.robot_goal

    def optimal_plans(self) -> PlanGraph | None:
        """The human's optimal plans from ``I``, or None where he has none."""
        return self.alone.plans(self.encoding.init)

    @cached_property
    def _followed(self) -> dict[HumanPlan, list[tuple[Op, Option]]]:
        return {}

    def followed(self, plan: HumanPlan) -> list[tuple[Op, Option]]:
        """The packed actions of a human plan and what they do, in order."""
        known = self._followed.get(plan)
        if known is None:
            ops = [self.encoding.op(i) for i in plan]
            known = self._followed[plan] = [(op, as_option(op, self.weights.team(op))) for op in ops]
        return known


def _both(task: Task) -> Condition:
    return Condition(
        tuple(sorted({*task.goal.positive, *task.robot_goal.positive})),
        tuple(sorted({*task.goal.negative, *task.robot_goal.negative})),
    )
