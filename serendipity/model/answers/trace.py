"""A simulation told epoch by epoch: what the human saw, expected and did, and what did not happen."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from serendipity.model.answers.fields import written
from serendipity.model.errors import limit_words
from serendipity.model.numbers import plain
from serendipity.model.task.plans import PlanStep
from serendipity.model.telling import Grid, Line, Output, counted

SCHEMA: Final = "serendipity.trace/1"

WHY: Final = {
    "inapplicable": "its preconditions do not hold",
    "conflict": "it gets in the way of another action",
    "refused": "it would cost the human more than going on alone",
}
"""Reasons why a step of the plan does not happen, in words."""


@dataclass(frozen=True, slots=True)
class TraceSkip:
    """A step of the plan that did not happen.

    Attributes:
        agents: names of those whom the plan wanted to take part.
        action: its name.
        why: a key of ``WHY``.
    """

    agents: tuple[str, ...]
    action: str
    why: str


@dataclass(frozen=True, slots=True)
class TraceEpoch:
    """One epoch as the human lived through it; costs are their own, undiscounted.

    Attributes:
        epoch: from 1.
        saw: facts that they found other than they expected, ``not`` in front of false ones;
            of those only that matter to what they can do.
        expected_cost: what was left of their former plan would cost (``c``), None where it
            does not work any more.
        best_cost: their optimal cost alone from here (``h``), None where there is no plan.
        decision: ``keeps`` their plan, ``replans``, or ``waits``.
        why: the decision in words.
        plan: what they mean to do, from this epoch on.
        did: what they do, joint actions included; None where they wait.
        failed: whether it turned out to be impossible.
        steps: what takes place, with what it costs the team.
        skipped: what the plan says and does not happen.
    """

    epoch: int
    saw: tuple[str, ...]
    expected_cost: float | None
    best_cost: float | None
    decision: str
    why: str
    plan: tuple[str, ...]
    did: str | None
    failed: bool
    steps: tuple[PlanStep, ...]
    skipped: tuple[TraceSkip, ...]


@dataclass(frozen=True, slots=True, repr=False)
class Trace(Output):
    """A plan played against a human who replans (semantics 6).

    Attributes:
        human: the human's name.
        human_model: ``observant`` or ``local``.
        realised: the goals hold, nothing was skipped or refused, and the cost is at most
            the promised one; None where a limit came before that was known.
        reason: why it is not realised, else None.
        goals_hold: whether the goals hold at the end; None where that was not reached.
        promised_cost: of the plan, for the team.
        cost: of what took place, for the team.
        epochs: until the goals hold, the horizon, or nothing can happen any more; fewer where a
            limit came first.
        limit: which limit that was (as ``Result.reason`` has it); None where it was played to its end.
    """

    human: str
    human_model: str
    realised: bool | None
    reason: str | None
    goals_hold: bool | None
    promised_cost: float
    cost: float
    epochs: tuple[TraceEpoch, ...]
    limit: str | None = None

    @property
    def complete(self) -> bool:
        """Whether it was played to its end."""
        return self.limit is None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        return {"schema": SCHEMA, "complete": self.complete, **written(self)}

    def lines(self) -> Iterator[str]:
        """The story in words, a line for each thing that happened."""
        for epoch in self.epochs:
            yield f"epoch {epoch.epoch}"
            if epoch.saw:
                yield f"  {self.human} sees: {', '.join(epoch.saw)}"
            if epoch.saw or epoch.decision != "keeps":
                yield f"  {self.human} {epoch.why}"
            yield f"  {self.human}: {self._deed(epoch)}"
            for step in epoch.steps:
                if self.human not in step.agents:
                    yield f"  {', '.join(step.agents)}: {step.action}"
            for skip in epoch.skipped:
                yield f"  does not happen: {skip.action} ({WHY[skip.why]})"
        yield self._verdict()

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``simulate`` prints."""
        return map(Line, self.lines())

    def _in_short(self) -> Iterator[str]:
        yield self.human
        yield counted(len(self.epochs), "epoch")
        yield self._verdict()

    def text(self) -> str:
        """The story as one text."""
        return "".join(f"{line}\n" for line in self.lines())

    def _deed(self, epoch: TraceEpoch) -> str:
        if epoch.did is None:
            going = self._going(epoch.epoch)
            return "waits" if going is None else f"goes on with {going}"
        return f"tries {epoch.did}, in vain" if epoch.failed else epoch.did

    def _going(self, epoch: int) -> str | None:
        """What the human began earlier and goes on with."""
        steps = (step for before in self.epochs for step in before.steps if self.human in step.agents)
        return next((step.action for step in steps if step.epoch < epoch <= step.end), None)

    def _verdict(self) -> str:
        costs = f"cost {plain(self.cost)}, promised {plain(self.promised_cost)}"
        if self.realised is None and self.limit is not None:
            return f"{limit_words(self.limit)}, after epoch {len(self.epochs)}: {costs} so far"
        if self.realised:
            return f"realised with the {self.human_model} human: {costs}"
        return f"not realised with the {self.human_model} human: {self.reason} ({costs})"
