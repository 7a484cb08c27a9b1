"""Why robots do what they do: values, which can be checked, and the words for them."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

from serendipity.model.numbers import plain

WHYS: Final = {
    "pays": "helps: {cost} for the team from here{guess}",
    "only-way": "helps: {human} has no plan alone, {cost} for the team from here{guess}",
    "owed": "makes up for the {owed} more that {human} would pay by what it has done",
    "goes-on": "goes on with {action}",
    "own-goals": "sees to goals of its own",
    "later": "waits: its part comes in epoch {epoch}",
    "unsure": "waits: not sure which goal ({goals})",
    "done": "all that helps is done",
    "no-help": "no help pays",
    "spoils": "help would pay ({cost} instead of {alone}), but spoil what {human} may be on the way to",
    "untold": "help would pay ({cost} instead of {alone}) only if {human} knew of it",
    "no-safe-help": "no help pays that leaves alone what {human} may need",
    "unfound": "no help that pays was found in time",
    "out-of-order": "out of order: {robots}",
    "all-failed": "all that is left to do has failed too often",
    "own-goals-spoil": "its own goals would spoil what {human} may be on the way to",
    "own-goals-lost": "its own goals are out of reach",
    "only-told": "{human} has no plan alone, and would have one with robots only if they knew of it ({cost})",
    "out-of-reach": "nothing that anybody could do gets {human} there",
    "late": "too late: no decision within the deadline, robots do nothing",
}
"""Kinds of reasons, and the words for them."""

CAUSES: Final = {
    "missed": "{what} did not take place in epoch {epoch}",
    "slow": "{what} took longer than epoch {epoch}",
    "elsewhere": "{human} did not {what} in epoch {epoch}",
    "out-of-order": "{what} is out of order",
    "changed": "something has changed after epoch {epoch}",
}
"""What may have come between help and its end, and the words for it."""


@dataclass(frozen=True, slots=True)
class Cause:
    """What has come between help and its end.

    Attributes:
        kind: a key of ``CAUSES``.
        epoch: in which, or after which.
        what: the action that did not take place or took longer, what the person was expected to do, or
            who is out of order.
    """

    kind: str
    epoch: int
    what: str = ""

    def text(self, human: str) -> str:
        """The cause in words."""
        return CAUSES[self.kind].format(epoch=self.epoch, what=self.what, human=human)


@dataclass(frozen=True, slots=True)
class Why:
    """Why robots do what they do in an epoch.

    Attributes:
        kind: a key of ``WHYS``.
        cost: what the plan that is spoken of costs the team from here.
        alone: what it costs the person from here without help; None where they have no plan.
        epoch: in which the robots' part comes.
        action: what robots go on with.
        robots: who is out of order.
        owed: how much dearer the person's way is by what robots have done; 0 where it is not.
        goals: the most probable goals, where there are several, with their probabilities.
        cause: what has come between help that had been decided on, and its end; None where nothing has.
    """

    kind: str
    cost: float | None = None
    alone: float | None = None
    epoch: int | None = None
    action: str | None = None
    robots: tuple[str, ...] = ()
    owed: float = 0.0
    goals: tuple[tuple[str, float], ...] = ()
    cause: Cause | None = None

    @classmethod
    def from_dict(cls, value: Mapping[str, Any]) -> "Why":
        """A reason as a log holds it."""
        cause = value["cause"]
        return cls(
            **{
                **value,
                "robots": tuple(value["robots"]),
                "goals": tuple((name, share) for name, share in value["goals"]),
                "cause": None if cause is None else Cause(**cause),
            }
        )

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        return {**asdict(self), "robots": list(self.robots), "goals": [list(pair) for pair in self.goals]}

    def text(self, human: str, verdict: str) -> str:
        """The reason in words, for a decision of some verdict about a person of that name."""
        likely = ", ".join(f"{name} {share:.0%}" for name, share in self.goals)
        words = WHYS[self.kind].format(
            human=human,
            cost=plain(self.cost),
            alone=plain(self.alone),
            epoch=self.epoch,
            owed=plain(self.owed),
            action=self.action,
            robots=", ".join(self.robots),
            goals=likely,
            guess=f", taking the goal to be {likely}" if likely else "",
        )
        if self.kind == "unsure" and self.epoch is not None:
            words += f"; its part comes in epoch {self.epoch}"
        because = None if self.cause is None else self.cause.text(human)
        if self.cause is not None and self.cause.kind == self.kind:
            words, because = because or words, None
        if self.owed and self.kind != "owed":
            words += f"; {human} pays {plain(self.owed)} more by what it has done, which can't be made up for"
        if verdict == "stopped":
            return f"stopped because {words}" if because is None else f"stopped because {because}: {words}"
        if verdict == "aside":
            return f"stays out of the way: {words}{f' ({because})' if because else ''}"
        return words
