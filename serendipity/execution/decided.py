"""Decisions for an epoch: what robots see and decide, and what came of it, as callers and logs have it."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from itertools import groupby
from typing import Any, Final, NamedTuple, Protocol

from serendipity.execution.why import Why
from serendipity.execution.world import WHY, Unfinished, World
from serendipity.model import Deadline, PlanStep, Window
from serendipity.model.answers.fields import written
from serendipity.model.numbers import plain
from serendipity.model.table import Cell
from serendipity.robot import Order, Report

VERDICTS: Final = {
    "helps": "robots do their part of a plan that pays",
    "works": "robots see to goals of their own",
    "waits": "there is a plan that pays, and robots have nothing to do in this epoch",
    "unsure": "what would pay depends on a goal that is not known yet",
    "aside": "robots stay out of the way",
    "stopped": "robots have given up help that they had begun",
    "late": "no decision within the deadline: robots do nothing",
}
"""What a decision amounts to."""

COLUMNS: Final = {
    "epoch": int,
    "human": str,
    "in_vain": bool,
    "steps": str,
    "unfinished": str,
    "human_cost": float,
    "cost": float,
    "done": bool,
    "verdict": str,
    "reason": str,
    "seconds": float,
}
"""Of a table of epochs that are over; what they mean is said at :class:`Passed` and :class:`Decided`."""


@dataclass(frozen=True, slots=True)
class Decided:
    """What robots mean to do in an epoch, before anybody knows what the person does in it.

    Attributes:
        epoch: from 1.
        verdict: a key of ``VERDICTS``.
        reason: the decision in words.
        actions: what robots are going to do without the person.
        offers: joint actions that the person may take part in; each happens only if they do.
        expected: what the robots take the person to do; None where they wait, or where nobody knows.
        plan: the plan that this is a part of, with its epochs counted from this one; None without one.
        window: where the person is met in that plan, as far as it says so.
        cost: what the rest costs the team by that plan.
        alone: what it costs the person without help.
        proved: whether the plan, or doing nothing, is known to be the best; not where time was up first.
        goals: the posterior of each candidate goal; empty where there is only one.
        wishes: what the plan has a person do who is told, by the goal that is theirs, where robots don't
            know it; None: wait.
        seconds: that the decision took.
        because: the reason as a value; None where whoever has decided gives none.
    """

    epoch: int
    verdict: str
    reason: str
    actions: tuple[PlanStep, ...] = ()
    offers: tuple[PlanStep, ...] = ()
    expected: PlanStep | None = None
    plan: tuple[PlanStep, ...] | None = None
    window: Window | None = None
    cost: float | None = None
    alone: float | None = None
    proved: bool = False
    goals: Mapping[str, float] = field(default_factory=dict)
    wishes: Mapping[str, str | None] = field(default_factory=dict)
    seconds: float = 0.0
    because: Why | None = None

    def at(self, seconds: float) -> "Decided":
        """The same with the time that it took."""
        return replace(self, seconds=seconds)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        return written(self, (field.name for field in fields(self) if field.name != "epoch"))


@dataclass(frozen=True, slots=True)
class Reported:
    """What robots were told to do, and what they report of it."""

    order: Order
    report: Report

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {**written(self.order), **self.report.to_dict()}


@dataclass(frozen=True, slots=True)
class Passed:
    """An epoch that is over.

    Attributes:
        epoch: from 1.
        decided: what robots meant to do.
        human: what the person chose, by name; None: they waited.
        in_vain: whether that turned out to be impossible.
        steps: what took place.
        unfinished: what robots meant to do, and what came of it instead.
        reports: what an adapter says of what it was told to do.
        changes: facts that have changed, ``!`` in front of those that are false now.
        human_cost: what the person has paid up to now, undiscounted.
        cost: what the team has paid up to now.
        done: whether the person's goal holds now.
        going: in time, what had begun before and went on, with the epochs that were left.
    """

    epoch: int
    decided: Decided
    human: str | None
    in_vain: bool
    steps: tuple[PlanStep, ...]
    unfinished: tuple[Unfinished, ...]
    reports: tuple[Reported, ...]
    changes: tuple[str, ...]
    human_cost: float
    cost: float
    done: bool
    going: tuple[PlanStep, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """The JSON object: a line of a log."""
        return {
            **written(self, ("epoch", "human", "in_vain", "steps", "unfinished")),
            **written(self, ("reports",) if self.reports else ()),
            **written(self, ("going",) if self.going else ()),
            **written(self, ("changes", "human_cost", "cost", "done")),
            "decision": self.decided.to_dict(),
        }

    def cells(self) -> tuple[Cell, ...]:
        """What stands in its row, below :data:`COLUMNS`."""
        return (
            self.epoch,
            self.human,
            self.in_vain,
            "; ".join(step.action for step in self.steps),
            "; ".join(unfinished.step.action for unfinished in self.unfinished),
            self.human_cost,
            self.cost,
            self.done,
            self.decided.verdict,
            self.decided.reason,
            self.decided.seconds,
        )

    def lines(self, human: str) -> list[str]:
        """The epoch in words, about a person of that name."""
        return list(event_lines(self.to_dict(), human))


def event_lines(event: Mapping[str, Any], human: str) -> Iterator[str]:
    """A line of a log in words.

    Args:
        event: of :attr:`Execution.events <serendipity.Execution>`.
        human: the person's name.
    """
    if "change" in event:
        facts = ", ".join(name if true else f"not {name}" for name, true in event["change"].items())
        yield f"something has changed: {facts}"
    elif "drop" in event:
        yield f"out of order: {', '.join(event['drop'])}"
    else:
        going = {agent: step["action"] for step in event.get("going", ()) for agent in step["agents"]}
        deed = event["human"] or (f"goes on with {going[human]}" if human in going else "waits")
        yield f"epoch {event['epoch']}: {human} {f'tries {deed}, in vain' if event['in_vain'] else deed}"
        told = {(*one["agents"], one["action"]): one for one in event.get("reports", ())}
        for step in event["steps"]:
            report = told.get((*step["agents"], step["action"]))
            if human not in step["agents"] or report is not None:
                yield f"  {', '.join(step['agents'])}: {step['action']}{_reported(report)}"
        for robot, action in going.items():
            if robot != human:
                yield f"  {robot}: goes on with {action}"
        for missed in event["unfinished"]:
            report = told.get((*missed["agents"], missed["action"]))
            yield f"  does not happen: {missed['action']} ({WHY[missed['why']]}){_reported(report)}"
        yield f"  robots: {event['decision']['reason']}"


def account(passed: Sequence[Passed], human: str, alone: float | None) -> Iterator[str]:
    """What robots did in some epochs, and what it came to.

    Args:
        passed: the epochs, from the first one on.
        human: the person's name.
        alone: what they would have paid alone; None where they had no plan.
    """
    for _, same in groupby(passed, key=_sentence):
        epochs = list(same)
        first, last = epochs[0], epochs[-1]
        span = f"Epoch {first.epoch}" if first is last else f"Epochs {first.epoch} to {last.epoch}"
        steps = [step for epoch in epochs for step in epoch.steps if step.agents != (human,)]
        does = f" ({', '.join(step.action for step in steps)})" if steps else ""
        yield f"{span}: {first.decided.reason}{does}."
    if passed:
        end = passed[-1]
        instead = "" if alone is None else f" instead of {plain(alone)} alone"
        arrived = f"{human} paid {plain(end.human_cost)}{instead}, the team {plain(end.cost)}."
        yield arrived if end.done else f"{human} is not there yet."


def _sentence(passed: Passed) -> tuple[object, ...]:
    """What epochs of one sentence have in common."""
    why = passed.decided.because
    return passed.decided.verdict, None if why is None else (why.kind, why.cause)


def _reported(report: Mapping[str, Any] | None) -> str:
    """What robots report, behind what they did."""
    if report is None:
        return ""
    note = f", {report['note']}" if report["note"] else ""
    return f": {report['seconds']:.3g} s{note}"


class Outlook(NamedTuple):
    """What robots see when they decide.

    Attributes:
        epoch: the epoch that is to come.
        world: the world.
        running: what they have begun and not finished.
    """

    epoch: int
    world: World
    running: tuple[PlanStep, ...]


class Robots(Protocol):
    """Whoever decides for the robots."""

    @property
    def goals(self) -> Mapping[str, float]:
        """The posterior of each candidate goal; empty where there is only one."""

    def decide(self, outlook: Outlook, deadline: Deadline) -> Decided:
        """What robots do in the epoch that is to come.

        Raises:
            LimitReachedError: the deadline came first; robots had better do nothing.
        """

    def saw(self, own: int | None, executed: Sequence[int], tried: int | None = None) -> None:
        """Take in an epoch, by action ids.

        Args:
            own: what the person did alone, or None.
            executed: everything that took place.
            tried: what the person tried alone in vain, or None.
        """

    def surprised(self) -> None:
        """The world is other than what actions have made it."""

    def drop(self, robots: Iterable[int]) -> None:
        """Robots, by agent ids, are out of order: nothing that they take part in is possible any more."""

    def unable(self, actions: Iterable[int]) -> None:
        """Actions, by id, have turned out to be more than robots can do."""
