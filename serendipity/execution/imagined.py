"""The person with one of the goals that may be theirs, as robots imagine them, and what to do beside them."""

from copy import copy

from search import PreparedTask
from search.modes.simulation.companion import Companion
from serendipity.execution.advice import Adviser
from serendipity.execution.amends import Amends, Selfless
from serendipity.execution.guard import Following, Hands
from serendipity.execution.reactive_adviser import ReactiveAdviser
from serendipity.execution.session_adviser import SessionAdviser
from serendipity.execution.unbound import Unbound
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.task import Task


class Imagined:
    """One goal.

    Args:
        task: the task with that goal.
        options: in force.
        hands: what robots can do.
        state: ids of the facts that are true, as the person knows.
        deadline: polled while tables are built.
        others: ids of actions that may pay if another goal is theirs.
        told: the person keeps to the robots' plan.

    Attributes:
        task: the task with that goal.
        companion: plans for them, and plays what becomes of plans.
        following: what they may be following.
        adviser: what robots had best do.
        unbound: what they could do if they had promised nothing.
        amends: how they make up for what they have done.
    """

    def __init__(
        self,
        task: Task,
        options: Options,
        hands: Hands,
        state: frozenset[int],
        deadline: Deadline,
        others: frozenset[int] = frozenset(),
        *,
        told: bool,
    ) -> None:
        omniscient = options.human_model == "omniscient"
        model = options.but(mode="serendipity", human_model="observant") if omniscient else options
        self.task = task
        prepared = PreparedTask(task.at(state, deadline))
        pointless = others - useful(prepared, deadline) if others else others
        self.companion = Companion(prepared, model, deadline, others)
        sees_all = model.human_model == "observant"
        self.following = Following(self.companion.human, state, sees_all=sees_all, strict=model.strict)
        by_session = bool(omniscient or task.robot_goal)
        self.adviser: Adviser = (
            SessionAdviser(task, options, hands, told=told)
            if by_session
            else ReactiveAdviser(task, options.discount, self.companion, hands, pointless)
        )
        self.unbound = Unbound(task, options, None if by_session else self.companion)
        free = task.with_goal(task.goal, Condition())  # robots' own goals wait
        selfless: Adviser = (
            SessionAdviser(free, options.but(discount=1), hands, told=told)
            if by_session
            else Selfless(task, prepared, model, others)
        )
        self.amends = Amends(task, options.discount, self.companion, selfless)

    def again(self) -> "Imagined":
        """The same, with the same tables, which goes its own way from here."""
        other = copy(self)
        other.following = self.following.again()
        other.adviser = self.adviser.again()
        other.amends = self.amends.again()
        return other


def useful(prepared: PreparedTask, deadline: Deadline) -> frozenset[int]:
    """Ids of the actions that contribute something to a task's goal, or to what a person does about it."""
    return frozenset(prepared.with_diversions(deadline).packed.useful)
