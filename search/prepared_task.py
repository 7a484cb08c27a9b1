"""A task made ready for planning: how it is packed, and what follows from that alone.

A task is a plain value.  What a search makes of it before it looks at a call's options takes
time that grows with the files, and serves every call; so there is an object that owns it, which
callers make, hold and move: to another state (:meth:`PreparedTask.at`), to another goal
(:meth:`PreparedTask.with_goal`).  Each table is built when a call first asks for it, under that
call's deadline; a deadline that comes first leaves nothing half made.
"""

from collections.abc import Sequence
from copy import copy
from math import prod

from search.bounds.achievers import shared_fields
from search.bounds.interactions import Interactions
from search.bounds.private_distances import OwnPrivateDistances
from search.human.pattern_database import PatternDatabase, private_fields, translated
from search.human.tables import HumanTables
from search.packed.cost_vector import CostScales
from search.packed.packed_task import PackedTask
from search.packed.packings import diversions, doubted, human_facts
from search.robots.tables import RobotTables
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.task import Task
from serendipity.model.task.visibility import Surroundings, surroundings


class TaskTables:
    """A packed task, and what follows from it whatever a call's options are.

    Args:
        packed: the packed task.
        human: what the human can do alone, where it is not to be found from the packed task.

    Attributes:
        packed: the packed task.
        scales: its costs as integers.
        human: what the human can do alone.
        robots: what robots can do.
    """

    def __init__(self, packed: PackedTask, human: HumanTables | None = None) -> None:
        self.packed = packed
        self.scales = CostScales(packed.costs)
        self.human = human or HumanTables(packed)
        self.robots = RobotTables(packed)
        self._interactions: Interactions | None = None
        self._private_distances: OwnPrivateDistances | None = None

    def interactions(self, deadline: Deadline) -> Interactions:
        """The human's ops, split at what they mention."""
        if self._interactions is None:
            self._interactions = Interactions(self.packed, self.human.graph(deadline).mask)
        return self._interactions

    def private_distances(self, deadline: Deadline) -> OwnPrivateDistances:
        """The human's ways backward, from goal and interactions."""
        if self._private_distances is None:
            graph, to_goal = self.human.graph(deadline), self.human.projection(deadline)
            interactions = self.interactions(deadline)
            self._private_distances = OwnPrivateDistances(
                self.packed, interactions, to_goal.distances, graph.moves
            )
        return self._private_distances

    def at(self, task: Task) -> "TaskTables":
        """The same for a task that differs in its initial state only."""
        moved = copy(self)
        moved.packed = self.packed.at(task)
        if not self.human.covers(moved.packed.init):
            moved.human = HumanTables(moved.packed)
            moved._interactions = moved._private_distances = None
        return moved


class PreparedTask:
    """A task with its packings, and their tables.

    Args:
        task: the task.

    Attributes:
        task: the task.
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        self._plain: TaskTables | None = None
        self._with_human_facts: TaskTables | None = None
        self._with_diversions: TaskTables | None = None
        self._doubtful: TaskTables | None = None
        self._complete: TaskTables | None = None
        self._diversions: tuple[int, ...] | None = None
        self._surroundings: Surroundings | None = None

    # -- how it is packed

    def plain(self, deadline: Deadline) -> TaskTables:
        """Packed are the facts that matter to the goals."""
        if self._plain is None:
            self._plain = self.including(frozenset(), deadline)
        return self._plain

    def with_human_facts(self, deadline: Deadline) -> TaskTables:
        """Also packed is every fact of the human's own domain (semantics 3.3)."""
        if self._with_human_facts is None:
            self._with_human_facts = self.including(human_facts(self.task), deadline)
        return self._with_human_facts

    def including(
        self, facts: frozenset[int], deadline: Deadline, actions: tuple[int, ...] = ()
    ) -> TaskTables:
        """Also packed are some facts and actions, which one call asks about; not kept."""
        return TaskTables(PackedTask(self.task, facts, deadline, actions))

    def with_diversions(self, deadline: Deadline) -> TaskTables:
        """Also packed is what a human who replans lets themselves be kept busy with (semantics 6)."""
        if self._with_diversions is None:
            found = self.diversions(deadline)
            self._with_diversions = (
                self.including(frozenset(), deadline, found) if found else self.plain(deadline)
            )
        return self._with_diversions

    def doubtful(self, deadline: Deadline) -> TaskTables:
        """Packed for a human who may be wrong, and sees what is where they are."""
        if self._doubtful is None:
            self._doubtful = self.doubting(frozenset(), deadline)
        return self._doubtful

    def doubting(self, facts: frozenset[int], deadline: Deadline) -> TaskTables:
        """The same with some facts besides, which one call asks about; not kept."""
        return self._doubting(facts.union(self.surroundings(deadline).located), deadline)

    def complete(self, deadline: Deadline) -> TaskTables:
        """The same with every fact packed, for callers who say what is visible."""
        if self._complete is None:
            self._complete = self._doubting(frozenset(range(len(self.task.facts))), deadline)
        return self._complete

    def _doubting(self, facts: frozenset[int], deadline: Deadline) -> TaskTables:
        plain = self.with_diversions(deadline)
        packed = PackedTask(doubted(self.task, deadline), facts, deadline, self.diversions(deadline))

        def projection(deadline: Deadline) -> PatternDatabase:
            return translated(plain.human.projection(deadline), plain.packed, packed)

        return TaskTables(packed, HumanTables(packed, projection))

    # -- what else follows from it

    def diversions(self, deadline: Deadline) -> tuple[int, ...]:
        """Joint actions that contribute to no goal, and still change what a human who replans does."""
        if self._diversions is None:
            self._diversions = diversions(self.plain(deadline).packed, deadline)
        return self._diversions

    def surroundings(self, deadline: Deadline) -> Surroundings:
        """What an agent sees from where they are."""
        if self._surroundings is None:
            self._surroundings = surroundings(self.task, deadline.tick)
        return self._surroundings

    # -- other tasks

    def at(self, state: frozenset[int], deadline: Deadline | None = None) -> "PreparedTask":
        """The task from another state, with as much of what is known of it as still holds.

        Args:
            state: ids of the facts that are true in it.
            deadline: polled where variables have to be found anew.

        Raises:
            LimitReachedError: the deadline came first.
        """
        moved = PreparedTask(self.task.at(state, deadline))
        if moved.task.variables is self.task.variables:
            moved._plain = None if self._plain is None else self._plain.at(moved.task)
            moved._diversions, moved._surroundings = self._diversions, self._surroundings
        return moved

    def with_goal(self, goal: Condition, robot_goal: Condition | None = None) -> "PreparedTask":
        """The task with another goal of the human's and, unless that is None, of the robots'.

        What matters to the goals is packed anew.
        """
        other = PreparedTask(self.task.with_goal(goal, robot_goal))
        other._surroundings = self._surroundings
        return other

    def with_goals(
        self, goals: Sequence[Condition], facts: frozenset[int], deadline: Deadline
    ) -> list["PreparedTask"]:
        """The task with each of several goals, all over one packing, so that states and actions are the same.

        Args:
            goals: goals of the human's.
            facts: ids of facts to pack besides what the goals ask for.
            deadline: polled.
        """
        asked = facts.union(*((*goal.positive, *goal.negative) for goal in goals))
        packed = self.including(asked, deadline).packed
        found = [self.with_goal(goal) for goal in goals]
        for other in found:
            other._plain = other._with_human_facts = TaskTables(packed.for_goal(other.task))
        return found


def prepare(task: Task, deadline: Deadline | None = None) -> PreparedTask:
    """Pack a task, and find what every call needs of it and what takes time linear in the files.

    That is what robots' actions do to what they share with the human, and the human's private
    distances, unless their private states may be more than the task has actions.  The first
    planning call finds it otherwise, within its time limit.

    Args:
        task: the task.
        deadline: polled for time, and asked for memory.

    Raises:
        LimitReachedError: the deadline came first.
    """
    deadline = deadline or Deadline()
    prepared = PreparedTask(task)
    tables = prepared.plain(deadline)
    transitions = tables.robots.transitions(deadline)
    for field in shared_fields(tables.packed, tables.robots.positions(deadline)):
        transitions.on(field)
    if _most_states(tables.packed) <= len(task.actions):
        tables.human.projection(deadline)
    return prepared


def _most_states(packed: PackedTask) -> int:
    """At least the number of the human's private states."""
    return prod(len(packed.values(field)) for field in private_fields(packed))
