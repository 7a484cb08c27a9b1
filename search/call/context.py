"""The context that all searches of a call share: packed task, key weights, bounds, the human alone."""

from collections.abc import Callable, Collection, Iterable, Sequence
from functools import cache, cached_property, reduce
from typing import TYPE_CHECKING

from search.bounds.first_interaction import no_team_bound
from search.bounds.interactions import Interactions
from search.bounds.private_distances import PrivateDistances
from search.call.prepared_task import PreparedTask, TaskTables
from search.engine.best_first import Node
from search.human.individual_planner import FoundPlan, IndividualPlanner, Memory
from search.human.pattern_database import NOTHING_KNOWN, NearestGoal, PatternDatabase
from search.human.strides import StridingPlanner, may_stride
from search.kernel.library import library
from search.packed.cost_vector import Weights
from search.packed.joint_actions import JointAction, as_option
from search.packed.operators import Operator, asked_by, changed, union
from search.packed.packed_task import PackedGoal
from search.packed.packings import asked_facts, human_facts
from search.packed.successor_generator import Successors
from search.robots.decoupled import Decoupled, DecoupledSuccessors
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan, Task

if TYPE_CHECKING:
    from search.classical.team import Team


class SearchContext:
    """The prepared task under the options of one call.

    Args:
        plan: ``pi_H`` where it is known; None while it is being predicted.
        tables: a packing of the task, with its tables; None for the one that the options ask for.
    """

    def __init__(
        self,
        prepared: PreparedTask,
        options: Options,
        deadline: Deadline,
        plan: HumanPlan | None = None,
        tables: TaskTables | None = None,
    ) -> None:
        self.prepared = prepared
        self.task = prepared.task
        self.options = options
        self.deadline = deadline
        self.plan = plan
        if tables is None:
            whole = options.preservation == "state"
            tables = prepared.with_human_facts(deadline) if whole else prepared.plain(deadline)
        self.tables = tables
        self.packed = tables.packed
        self.weights = Weights(self.packed, tables.scaling, options, plan)
        self.keys = self.weights.keys
        self._followed: dict[HumanPlan, list[tuple[Operator, JointAction]]] = {}
        self._successors: dict[tuple[bool, frozenset[int]], Successors] = {}

    def for_plan(self, plan: HumanPlan) -> "SearchContext":
        """The context in which ``pi_H`` is known; this one, where that makes no difference."""
        options, tables = self.options, self.tables
        needed = asked_facts(self.task, plan)
        if any(self.packed.fact_bits[fact] is None for fact in needed):
            if options.preservation == "state":
                needed |= human_facts(self.task)
            tables = self.prepared.including(needed, self.deadline)
        elif options.mode != "communication" or not options.communication_weight:
            return self
        return SearchContext(self.prepared, options, self.deadline, plan, tables)

    @cached_property
    def bound(self) -> PatternDatabase:
        """Lower bound on what the human still has to pay for ``G_H``."""
        own = self.tables.human.projection(self.deadline)
        keys = map(cache(self.weights.of_own), own.distances.values())  # few of them differ
        return PatternDatabase(own.mask, dict(zip(own.distances, keys, strict=True)))

    @property
    def steps(self) -> PatternDatabase:
        """Lower bound on the number of the human's actions to ``G_H``."""
        return self.tables.human.steps(self.deadline)

    @cached_property
    def relevant(self) -> int:
        """The fields that matter to the human alone, to a goal, or to what happens without being chosen."""
        packed = self.packed
        goals = packed.goal.mask | packed.robot_goal.mask | packed.at_rest.mask
        return packed.own_mask | goals | union(asked_by(op) for _, _, op in packed.due)

    @cached_property
    def alone(self) -> IndividualPlanner:
        """The human alone, to ``G_H``."""
        if self.weights.announces:
            return self._alone_to(self.packed.goal)
        packed, human = self.packed, self.tables.human
        bound = NOTHING_KNOWN  # the kernel knows more than private distances say, which can take seconds
        if not self.distances_say_little or library() is None:
            bound = human.projection(self.deadline)
        # What it finds serves calls that weigh otherwise.
        memory = human.memory(strict=self.options.strict)
        if packed.in_time and may_stride(packed, strict=memory.strict):
            alone = human.alone(self.deadline)
            nearest = bound if alone is None else NearestGoal(human.projection(self.deadline), alone)
            return StridingPlanner(packed, nearest, memory, self.deadline, self.weights)
        return IndividualPlanner(packed, packed.goal, bound, memory, self.deadline, prices=self.weights)

    def _alone_to(self, goal: PackedGoal) -> IndividualPlanner:
        """The human alone, to a goal that this call asks about."""
        memory = Memory(self.packed, self.weights.alone, strict=self.options.strict)
        return IndividualPlanner(self.packed, goal, self.bound, memory, self.deadline)

    @cached_property
    def alone_to_both(self) -> IndividualPlanner | None:
        """The human alone, to ``G_H`` and ``G_R``; None where they can't affect ``G_R``."""
        task, goal = self.task, self.task.robot_goal
        asked, own = {*goal.positive, *goal.negative}, (task.actions[i] for i in task.human_actions)
        if not asked or asked.isdisjoint(fact for a in own for fact in (*a.add, *a.delete)):
            return None
        return self._alone_to(self.packed.condition(_both(task)))

    @property
    def interactions(self) -> Interactions:
        """What the human's ops mention."""
        return self.tables.interactions(self.deadline)

    @cached_property
    def ways(self) -> PrivateDistances:
        """The human's ways to their touches."""
        return PrivateDistances(self.interactions, self.bound, self.steps, self.weights, self.deadline)

    def successors(self, *, idle: bool = False, barred: Collection[int] = ()) -> Successors:
        """Action sets, kept as they are found; with ``idle`` robots do nothing, else nothing barred."""
        asked, strict, weight = (idle, frozenset(barred)), self.options.strict, self.weights.team
        if asked not in self._successors:
            found = Successors(self.packed, weight, self.deadline, strict=strict, idle=idle, barred=barred)
            self._successors[asked] = found
        return self._successors[asked]

    def walks(self, plan: HumanPlan) -> Decoupled | None:
        """Robots' walks where they can be folded, and it pays: several robots, or walks that take time."""
        if (len(self.task.robots) < 2 and not self.task.due) or self.options.preservation == "state":
            return None
        walks = self.tables.decoupled(self.deadline)
        touched = any(self.packed.mentioned(self.packed.op(i)) & walks.mask for i in plan)
        return walks if walks.foldable and not touched else None

    def folded(self, walks: Decoupled) -> DecoupledSuccessors:
        """:meth:`successors` with walks left out."""
        strict = self.options.strict
        return DecoupledSuccessors(self.packed, walks, self.weights, self.deadline, strict=strict)

    @cached_property
    def distances_say_little(self) -> bool:
        """Whether private distances say little of the goal: it asks for what others change too, or they leave
        out some of too many private variables.
        """
        if (self.packed.goal.mask | self.packed.robot_goal.mask) & self.packed.outside:
            return True
        return not self.tables.human.keeps_all(self.deadline)

    @cached_property
    def team(self) -> "Team | None":
        """The team where epochs don't count; None without a kernel that could tell.

        A call has its own: what an earlier one has learnt would decide between plans of equal rank.
        """
        from search.classical.team import team_planner  # only here: most calls come by without it

        goal = self.packed.condition(_both(self.task)) if self.task.robot_goal else self.packed.goal
        return team_planner(self.packed, goal, self.weights, self.deadline, strict=self.options.strict)

    @cached_property
    def team_bound(self) -> Callable[[int], int]:
        """Bound on what the team pays from a packed state; 0 where private distances say enough."""
        team = self.team if self.distances_say_little else None
        if team is None:
            return no_team_bound
        planner, key_of = team.planner, self.weights.key_of
        return cache(lambda state: key_of(planner.bound(state, self.deadline)))

    def under(self, deadline: Deadline) -> "SearchContext":
        """The same call with another deadline."""
        return SearchContext(self.prepared, self.options, deadline, self.plan, self.tables)

    @property
    def root(self) -> Node:
        """The node before all epochs."""
        return Node(0, 0, self.packed.init, 0, 0, None, ())

    def played(self, epochs: Iterable[Sequence[Operator]]) -> Node:
        """The node after epochs in each of which some ops happen."""
        return reduce(self.after, epochs, self.root)

    def by_epoch(self, steps: Iterable[Step], last: int) -> list[list[Operator]]:
        """The ops of some steps, epoch by epoch up to a last one."""
        found: list[list[Operator]] = [[] for _ in range(last)]
        for step in steps:
            if step.epoch <= last:
                found[step.epoch - 1].append(self.packed.op(step.action))
        return found

    def after(self, node: Node, ops: Sequence[Operator]) -> Node:
        """The node after an epoch in which ops happen together."""
        key, actions = node.key + sum(map(self.weights.team, ops)), tuple(op.action for op in ops)
        return Node(key, node.epoch + 1, changed(node.state, ops), 0, node.start, node, actions)

    @property
    def goals(self) -> tuple[PackedGoal, ...]:
        """``G_H``, ``G_R``, and robots at rest where they take time, packed."""
        packed = self.packed
        goals = packed.goal, packed.robot_goal
        return (*goals, packed.at_rest) if packed.at_rest.mask else goals

    def canonical_plan(self) -> FoundPlan | None:
        """The human's canonical plan from ``I``, or None where they have none."""
        return self.alone.canonical(self.packed.init)

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
