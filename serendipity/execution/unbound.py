"""What help would come to if robots had promised nothing: the reason why they do nothing."""

from dataclasses import dataclass
from typing import Any

from search.modes.simulation.companion import Companion
from serendipity.execution.advice import Question, without
from serendipity.execution.why import Why
from serendipity.facade.session import Session
from serendipity.model.errors import LimitReachedError, PlanError
from serendipity.model.keywords import HumanModel
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition, apply
from serendipity.model.task.task import HumanPlan, Task


@dataclass(frozen=True, slots=True)
class _Nothing:
    """Where no help pays: what is so now is so while the person goes on, and robots do nothing."""

    state: frozenset[int]
    barred: frozenset[int]
    promise: HumanPlan


class Unbound:
    """Asks again what was asked of an adviser, without what robots promise.

    Args:
        task: the task with one of the goals that the person may have.
        options: in force.
        companion: plays the person, and plans beside them; None: robots have goals of their own, or take the
            person to be omniscient.
    """

    def __init__(self, task: Task, options: Options, companion: Companion | None) -> None:
        self._task = task
        self._companion = companion
        self._options: dict[str, Any] = {"discount": options.discount, "interference": options.interference}
        self._model = options.human_model
        self._nothing: _Nothing | None = None
        self._session: tuple[frozenset[int], Session] | None = None

    def why(self, question: Question, deadline: Deadline) -> Why:
        """Why no help is given: none pays; or only such that spoils something, or that has to be announced.

        Raises:
            LimitReachedError: the deadline came first.
        """
        promise = question.following.promise()
        here = _Nothing(question.state, question.barred, promise)
        if here != self._nothing:
            found = self._reactive(question, deadline) or self._planned(question, promise, deadline)
            if found is not None:
                return found
        after = apply(question.state, *(self._task.actions[i] for i in promise[:1]))
        self._nothing = _Nothing(after, question.barred, promise[1:])
        return Why("no-help")

    def _reactive(self, question: Question, deadline: Deadline) -> Why | None:
        """Help beside the person as robots take them to be."""
        if self._companion is None:
            return None
        start = question.following.start
        course = self._companion.course(start, [question.barred], deadline, keeps=False)
        if course is None or course.alone is None:
            return None
        if course.pays:
            return Why("spoils", float(course.cost), float(course.alone))
        if not course.proved:
            raise LimitReachedError("time-limit")
        return None

    def _planned(self, question: Question, promise: HumanPlan, deadline: Deadline) -> Why | None:
        """Help as the semantics have it."""
        session = self._at(question)
        models: tuple[HumanModel, ...] = (
            ("omniscient",) if self._companion is not None else (self._model, "omniscient")
        )
        for model in dict.fromkeys(models):
            session.follow([self._task.actions[i].name for i in promise])
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

    def why_not_even_alone(self, question: Question, deadline: Deadline) -> Why:
        """Why there is no plan, though the person has one: robots' own goals are out of reach.

        Raises:
            LimitReachedError: the deadline came first; so does the other.
        """
        session = self._at(question)
        session.follow([self._task.actions[i].name for i in question.following.promise()])
        found = session.plan(human_model=self._model, deadline=deadline)
        if found.status == "unknown":
            raise LimitReachedError("time-limit")
        return Why("own-goals-lost" if found.plan is None else "own-goals-spoil")

    def why_out_of_reach(self, question: Question, deadline: Deadline) -> Why:
        """Why somebody who has no plan alone, and knows of none, does not get there."""
        free = without(self._task, question.out).with_goal(self._task.goal, Condition())
        options = {**self._options, "mode": "composite", "horizon": INFINITE}
        found = Session(free.at(question.state), **options).plan(deadline=deadline)
        if found.status == "unknown":
            raise LimitReachedError("time-limit")
        return Why("out-of-reach") if found.cost is None else Why("only-told", found.cost)

    def _at(self, question: Question) -> Session:
        """A session where things stand, with those who are at hand."""
        if self._session is None or self._session[0] != question.barred:
            self._session = question.barred, Session(without(self._task, question.barred), **self._options)
        session = self._session[1]
        moved = session.task.init ^ question.state
        session.change({self._task.facts[fact]: fact in question.state for fact in sorted(moved)})
        return session
