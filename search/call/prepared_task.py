"""A task made ready for planning: how it is packed, and what follows from that alone.

A task is a plain value.  What a search makes of it before it looks at a call's options takes
time that grows with the files, and serves every call; so there is an object that owns it, which
callers make, hold and move: to another state (:meth:`PreparedTask.at`), to another goal
(:meth:`PreparedTask.with_goal`).  Each table is built when a call first asks for it, under that
call's deadline; a deadline that comes first leaves nothing half made.
"""

from collections.abc import Iterable, Sequence
from copy import copy
from functools import cache, partial
from math import prod

from search.bounds.achievers import shared_fields
from search.bounds.interactions import Interactions
from search.human.pattern_database import PatternDatabase, private_fields, translated
from search.human.tables import HumanTables
from search.packed.cost_vector import scaled_costs
from search.packed.packed_task import PackedTask
from search.packed.packings import diversions, doubted, human_facts
from search.packed.table import KeptTable
from search.robots.decoupled import Decoupled
from search.robots.transition_graphs import PositionVariables, TransitionGraphs
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.task import Task
from serendipity.model.task.visibility import surroundings


class TaskTables:
    """A packed task, and what follows from it whatever a call's options are.

    Args:
        human: what the human can do alone, where it is not to be found from the packed task.

    Attributes:
        scaling: its costs as integers, by options.
        human: what the human can do alone.
        positions: the place of each robot, and what moves it.
        transitions: what robots' ops do to each variable.
        decoupled: the walks of robots that can be folded.
        interactions: the human's ops, split at what they mention.
    """

    def __init__(self, packed: PackedTask, human: HumanTables | None = None) -> None:
        self.packed = packed
        self.scaling = cache(partial(scaled_costs, packed.costs))
        self.human = human or HumanTables(packed)
        self.positions = positions = KeptTable(partial(PositionVariables, packed))
        self.transitions = KeptTable(lambda deadline: TransitionGraphs(packed, positions(deadline)))
        self.decoupled = KeptTable(lambda deadline: Decoupled(packed, positions(deadline), deadline))
        self.interactions = _interactions(packed, self.human)

    def at(self, task: Task) -> "TaskTables":
        """The same for a task that differs in its initial state only."""
        moved = copy(self)
        moved.packed = self.packed.at(task)
        if not self.human.covers(moved.packed.init):
            moved.human = HumanTables(moved.packed)
            moved.interactions = _interactions(moved.packed, moved.human)
        return moved


def _interactions(packed: PackedTask, human: HumanTables) -> KeptTable[Interactions]:
    return KeptTable(lambda deadline: Interactions(packed, human.graph(deadline).mask))


class PreparedTask:
    """A task with its packings, and their tables.

    Attributes:
        plain: packed are the facts that matter to the goals.
        with_human_facts: also packed is every fact of the human's own domain (semantics 3.3).
        with_diversions: also packed is what a human who replans may be kept busy with (semantics 6).
        doubtful: packed for a human who may be wrong, and sees what is where they are.
        complete: the same with every fact packed, for callers who say what is visible.
        diversions: joint actions that contribute to no goal, and still change what such a human does.
        surroundings: what an agent sees from where they are.
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        plain = KeptTable(lambda deadline: TaskTables(PackedTask(task, frozenset(), deadline)))
        kept = KeptTable(lambda deadline: diversions(plain(deadline).packed, deadline))
        diverted = KeptTable(lambda deadline: _diverted(plain(deadline), kept(deadline), deadline))
        seen = KeptTable(lambda deadline: surroundings(task, deadline.tick))
        self.plain, self.with_diversions, self.diversions, self.surroundings = plain, diverted, kept, seen
        self.with_human_facts = KeptTable(
            lambda deadline: TaskTables(PackedTask(task, human_facts(task), deadline))
        )
        self._doubting = doubting = partial(_doubting, diverted, kept)
        self.doubtful = KeptTable(lambda deadline: doubting(seen(deadline).located, deadline))
        self.complete = KeptTable(lambda deadline: doubting(range(len(task.facts)), deadline))

    def including(
        self, facts: frozenset[int], deadline: Deadline, actions: tuple[int, ...] = ()
    ) -> TaskTables:
        """Also packed are some facts and actions, which one call asks about; not kept."""
        return TaskTables(PackedTask(self.task, facts, deadline, actions))

    def doubting(self, facts: frozenset[int], deadline: Deadline) -> TaskTables:
        """:attr:`doubtful` with some facts besides, which one call asks about; not kept."""
        return self._doubting(facts.union(self.surroundings(deadline).located), deadline)

    # -- other tasks

    def at(self, state: frozenset[int], deadline: Deadline | None = None) -> "PreparedTask":
        """The task from another state, with as much of what is known of it as still holds.

        Args:
            state: ids of the facts that are true in it.
            deadline: polled where variables have to be found anew.
        """
        moved = PreparedTask(self.task.at(state, deadline))
        if moved.task.variables is self.task.variables:
            if self.plain.known is not None:
                moved.plain.known = (self.plain.known[0].at(moved.task),)
            moved.diversions.known, moved.surroundings.known = self.diversions.known, self.surroundings.known
        return moved

    def with_goal(self, goal: Condition, robot_goal: Condition | None = None) -> "PreparedTask":
        """The task with another goal of the human's and, unless that is None, of the robots'.

        What matters to the goals is packed anew, unless they are those of the task.
        """
        if goal == self.task.goal and robot_goal in (None, self.task.robot_goal):
            return self
        return self._made_for(goal, robot_goal)

    def _made_for(self, goal: Condition, robot_goal: Condition | None = None) -> "PreparedTask":
        other = PreparedTask(self.task.with_goal(goal, robot_goal))
        other.surroundings.known = self.surroundings.known
        return other

    def with_goals(
        self, goals: Sequence[tuple[Condition, Condition]], facts: frozenset[int], deadline: Deadline
    ) -> list["PreparedTask"]:
        """The task with each of several goals, all over one packing, so that states and actions are the same.

        Args:
            goals: of the human's, each with one of the robots'.
            facts: ids of facts to pack besides what the goals ask for.
        """
        asked = facts.union(*((*one.positive, *one.negative) for pair in goals for one in pair))
        packed = self.including(asked, deadline).packed
        found = [self._made_for(goal, theirs) for goal, theirs in goals]
        for other in found:
            other.plain.known = other.with_human_facts.known = (TaskTables(packed.for_goal(other.task)),)
        return found


def _diverted(plain: TaskTables, kept: tuple[int, ...], deadline: Deadline) -> TaskTables:
    """The plain packing, and actions that are kept though they contribute to nothing."""
    return TaskTables(PackedTask(plain.packed.task, frozenset(), deadline, kept)) if kept else plain


def _doubting(
    diverted: KeptTable[TaskTables],
    kept: KeptTable[tuple[int, ...]],
    facts: Iterable[int],
    deadline: Deadline,
) -> TaskTables:
    """The same for a human who may be wrong, with some facts besides."""
    tables = diverted(deadline)
    packed = PackedTask(doubted(tables.packed.task, deadline), frozenset(facts), deadline, kept(deadline))

    def projection(deadline: Deadline) -> PatternDatabase:
        return translated(tables.human.projection(deadline), tables.packed, packed)

    return TaskTables(packed, HumanTables(packed, projection))


def prepare(task: Task, deadline: Deadline | None = None) -> PreparedTask:
    """Pack a task, and find what every call needs of it and what takes time linear in the files.

    That is what robots' actions do to what they share with the human, and the human's private
    distances, unless their private states may be more than the task has actions.  The first
    planning call finds it otherwise, within its time limit.

    Args:
        deadline: polled for time, and asked for memory.
    """
    deadline = deadline or Deadline()
    prepared = PreparedTask(task)
    tables = prepared.plain(deadline)
    transitions = tables.transitions(deadline)
    for field in shared_fields(tables.packed, tables.positions(deadline)):
        transitions.on(field)
    most_states = prod(len(tables.packed.values(field)) for field in private_fields(tables.packed))
    if most_states <= len(task.actions):
        tables.human.projection(deadline)
    return prepared
