"""Help if robots had promised nothing: the reason why they do nothing."""

from search.modes.simulation.companion import Companion
from serendipity.execution.advice import DecisionPoint
from serendipity.execution.guard import Following
from serendipity.execution.session_adviser import RestrictedSessions
from serendipity.execution.why import Why
from serendipity.facade.session import Session
from serendipity.model import INFINITE, Deadline, HumanModel, HumanPlan, Options, Task
from serendipity.model.errors import LimitReachedError, PlanError
from serendipity.model.task.actions import Condition, apply


class Unbound:
    """Asks again what was asked of an adviser, without what robots promise.

    Args:
        task: the task with one of the goals that the person may have.
        companion: plays the person, and plans beside them; None: robots have goals of their own, or take the
            person to be omniscient.
    """

    def __init__(self, task: Task, options: Options, companion: Companion | None) -> None:
        self._task = task
        self._companion = companion
        self._model = options.human_model
        common = {"discount": options.discount, "interference": options.interference}
        self._sessions = RestrictedSessions(task, **common)
        free = task.with_goal(task.goal, Condition())
        self._joint = RestrictedSessions(free, **common, mode="composite", horizon=INFINITE)
        self._nothing: tuple[frozenset[int], frozenset[int], HumanPlan] | None = None
        """Where no help pays: state, what is barred, promise; it stays so while all goes as promised."""

    def why(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Why:
        """Why no help is given: none pays; or only such that spoils something, or that has to be announced.

        Raises:
            LimitReachedError: the deadline came first; so do other methods.
        """
        promise = following.promise()
        if self._nothing != (now.state, now.barred, promise):
            found = self._reactive(following, now, deadline) or self._planned(promise, now, deadline)
            if found is not None:
                return found
        after = apply(now.state, *(self._task.actions[i] for i in promise[:1]))
        self._nothing = after, now.barred, promise[1:]
        return Why("no-help")

    def _reactive(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Why | None:
        """Help beside the person as robots take them to be."""
        if self._companion is None:
            return None
        start = following.start_of(self._companion.human)
        course = self._companion.course(start, [now.barred], deadline, keeps=False)
        if course is None or course.alone is None:
            return None
        if course.pays:
            return Why("spoils", float(course.cost), float(course.alone))
        if not course.proved:
            raise LimitReachedError("time-limit")
        return None

    def _planned(self, promise: HumanPlan, now: DecisionPoint, deadline: Deadline) -> Why | None:
        """Help as the semantics have it; who has nothing to do needs none."""
        if not promise:
            return None
        models: tuple[HumanModel, ...] = (
            ("omniscient",) if self._companion is not None else (self._model, "omniscient")
        )
        for model in dict.fromkeys(models):
            session = self._promised(promise, now)
            try:
                found = session.plan(human_model=model, deadline=deadline)
            except PlanError:  # what somebody believes who does not see everything
                continue
            if found.opportunity and found.cost is not None and found.saving is not None:
                kind = "spoils" if self._companion is None and model == self._model else "untold"
                return Why(kind, found.cost, found.cost + found.saving)
            if found.status != "optimal":
                raise LimitReachedError("time-limit")
        return None

    def why_not_even_alone(self, following: Following, now: DecisionPoint, deadline: Deadline) -> Why:
        """Why there is no plan, though the person has one: robots' own goals are out of reach."""
        promise = following.promise()
        session = self._promised(promise, now)
        if promise:
            found = session.plan(human_model=self._model, deadline=deadline)
        else:  # who has nothing to do sets no horizon
            found = session.plan(mode="composite", horizon="inf", deadline=deadline)
        if found.status == "unknown":
            raise LimitReachedError("time-limit")
        return Why("own-goals-lost" if found.plan is None else "own-goals-spoil")

    def why_out_of_reach(self, now: DecisionPoint, deadline: Deadline) -> Why:
        """Why somebody who has no plan alone, and knows of none, does not get there."""
        found = self._joint.at(now.state, now.out).plan(deadline=deadline)
        if found.status == "unknown":
            raise LimitReachedError("time-limit")
        return Why("out-of-reach") if found.cost is None else Why("only-told", found.cost)

    def _promised(self, promise: HumanPlan, now: DecisionPoint) -> Session:
        """A session where things stand, with those who are at hand, and a person who keeps a promise."""
        session = self._sessions.at(now.state, now.barred)
        session.follow([self._task.actions[i].name for i in promise])
        return session
