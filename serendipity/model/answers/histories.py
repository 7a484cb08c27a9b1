"""What robots may have seen when they act: the histories of an answer over scenarios (semantics 11)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from serendipity.model.answers.result_parts import GoalAnswer
from serendipity.model.task.plans import PlanStep


@dataclass(frozen=True, slots=True)
class History:
    """Epochs in which the same scenarios are possible.

    Attributes:
        end: the first epoch after them.
        scenarios: those that are possible, by their places in the answer.
        robots: what robots take part in then, in any of the scenarios.
        branches: the histories that may follow.
        seen: what the human did in the epoch before, by which it is known; None if they waited, and at first.
    """

    start: int
    end: int
    scenarios: tuple[int, ...]
    robots: tuple[PlanStep, ...]
    branches: "tuple[History, ...]"
    seen: PlanStep | None

    def __iter__(self) -> "Iterator[History]":
        """This one and all that may follow, each before its branches."""
        yield self
        for branch in self.branches:
            yield from branch


def histories(scenarios: Sequence[GoalAnswer], human: str, horizon: int, *, watching: bool = True) -> History:
    """The histories of an answer, where robots perhaps tell scenarios apart by what the human does."""
    done = [{step.epoch: step for step in s.plan or () if human in step.agents} for s in scenarios]

    def from_epoch(start: int, possible: tuple[int, ...]) -> History:
        end = start
        parts: list[tuple[int, ...]] = [possible]
        while end <= horizon and len(parts) == 1:
            seen: dict[str | None, list[int]] = {}
            for i in possible if watching else ():
                step = done[i].get(end)
                seen.setdefault(None if step is None else step.action, []).append(i)
            parts = [tuple(part) for part in seen.values()] or parts
            end += 1
        robots = {
            step
            for i in possible
            for step in scenarios[i].plan or ()
            if start <= step.epoch < end and set(step.agents) != {human}
        }
        branches = tuple(from_epoch(end, part) for part in parts) if len(parts) > 1 and end <= horizon else ()
        in_order = sorted(robots, key=lambda step: (step.epoch, step.action))
        seen_before = done[possible[0]].get(start - 1)
        return History(start, end, possible, tuple(in_order), branches, seen_before)

    return from_epoch(1, tuple(range(len(scenarios))))
