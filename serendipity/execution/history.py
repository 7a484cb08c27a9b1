"""The history of help: whether it has begun, what has come between, and what would be so without it."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from serendipity.execution.decided import Decided
from serendipity.execution.why import Cause
from serendipity.model import PlanStep, Task
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import participants

_AT_IT = ("helps", "waits")
"""Verdicts of a decision that follows a plan which pays."""


class HelpHistory:
    """What was decided in a task, and what has become of it.

    Attributes:
        helped: whether robots have done anything for help.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self._human = task.agents[task.human]
        self._last: Decided | None = None
        self.helped = self._begun = False
        self._cause: Cause | None = None

    def saw(self, executed: Sequence[int]) -> None:
        """Take in what took place, by action ids."""
        last = self._last
        if last is None or last.verdict not in _AT_IT:
            return
        done = {(participants(self._task, a), a.name) for a in (self._task.actions[i] for i in executed)}
        if any(agents != (self._human,) for agents, _ in done):
            self.helped = self._begun = True
        his = next((name for agents, name in done if self._human in agents), None)
        missed = [step for step in last.actions if (step.agents, step.action) not in done]
        expected = None if last.expected is None else last.expected.action
        offered = any(step.action == expected for step in last.offers)
        if missed:
            self._cause = Cause("missed", last.epoch, missed[0].action)
        elif last.plan is not None and his != expected and his not in last.wishes.values():
            kind = "missed" if his is None and offered else "elsewhere"
            self._cause = Cause(kind, last.epoch, expected or "wait")

    def broken(self, kind: str, what: str = "") -> None:
        """Say what has come between; a key of ``CAUSES``."""
        if self._last is not None and self._last.verdict in _AT_IT:
            self._cause = Cause(kind, self._last.epoch, what)

    def told(self, decided: Decided, running: Iterable[PlanStep] = ()) -> Decided:
        """A decision in words, with what has come between.

        Args:
            decided: the decision; help that has begun, and is given up by it, is stopped.
            running: what robots have begun and not finished.
        """
        why = decided.because
        assert why is not None, "what is decided has a reason"
        cause = self._cause
        if cause is not None and any(step.action == cause.what for step in running):
            cause = replace(cause, kind="slow")
        verdict = decided.verdict
        if verdict == "aside":
            if why.kind == "done":
                self._begun, cause = False, None
            elif self._begun:
                verdict = "stopped"
            why = replace(why, cause=cause)
        elif decided.plan is not None:  # else what was begun is finished, and nothing else is known yet
            cause = None
        self._cause = cause
        reason = why.text(self._human, verdict)
        self._last = replace(decided, verdict=verdict, because=why, reason=reason)
        return self._last


class Untouched:
    """The state as it would be if robots had done nothing since the person last took something from them.

    Attributes:
        state: ids of the facts that would be true.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self.state = task.init
        self._known = False

    def saw(self, own: int | None, executed: Sequence[int]) -> None:
        """Take in an epoch: what the person did alone, and everything that took place, by action ids."""
        actions = self._task.actions
        if any(self._task.human in actions[i].participants for i in executed if i != own):
            self._known = False
        elif own is not None:
            self._known &= actions[own].applicable(self.state)
            self.state = apply(self.state, actions[own])

    def forget(self) -> None:
        """What is true has changed otherwise."""
        self._known = False

    def look(self, state: frozenset[int]) -> None:
        """Say which facts are true, by their ids."""
        if not self._known:
            self.state, self._known = state, True
