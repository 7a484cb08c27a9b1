"""What happens under a policy in each scenario, read off the groups of its search (semantics 11)."""

from collections.abc import Sequence
from typing import NamedTuple

from search.engine.paths import plan_steps
from search.modes.scenarios.lines import OVER, Line
from search.modes.scenarios.measure import Member
from search.modes.scenarios.policies import Choice, Group
from serendipity.model.task.plans import Step, Window


class Played(NamedTuple):
    """What happens in one scenario.

    Attributes:
        steps: what everybody does.
        window: in which the human's plan is interrupted, or None.
    """

    steps: tuple[Step, ...]
    window: Window | None


class _Course:
    """A scenario as far as it has come."""

    def __init__(self) -> None:
        self.steps: list[Step] = []
        self.start = self.end = 0

    def go_on(self, choice: Choice, at: Member, number: int, epoch: int) -> None:
        """An epoch of a choice; ``number`` is the scenario's place in its group."""
        way = choice.ways[number]
        self.steps += [Step(epoch, action) for action in (*way.part.actions, *choice.robots.actions)]
        if way.opens:
            self.start = epoch
        if way.after.phase == OVER and at.phase != OVER:
            self.end = epoch + 1

    def finish(self, line: Line, at: Member, epoch: int, *, certain: bool) -> None:
        """All that is left: the suffix, the ordinary call's plan, or the human's own."""
        rest = line.rest(at, epoch) if certain and at.phase != OVER else None
        if rest is not None:
            self.steps += [Step(step.epoch + epoch, step.action) for step in rest.steps]
            if rest.window is not None:
                self.start = self.start or rest.window.start + epoch
                self.end = rest.window.end + epoch
        else:
            self.steps += plan_steps(line.left_alone(at, epoch), epoch + 1)

    @property
    def played(self) -> Played:
        return Played(tuple(sorted(self.steps)), Window(self.start, self.end) if self.end else None)


def played(root: Group, lines: Sequence[Line]) -> dict[int, Played]:
    """What happens in each scenario under the best policy known of a group."""
    courses = {m.scenario: _Course() for m in root.members}
    pending = [root]
    while pending:
        group = pending.pop()
        for number, at in enumerate(group.members):
            course = courses[at.scenario]
            if group.choice is None:
                course.finish(lines[at.scenario], at, group.epoch, certain=len(group.members) == 1)
            else:
                course.go_on(group.choice, at, number, group.epoch + 1)
        if group.choice is not None:
            pending += [after for _, after in group.choice.branches]
    return {scenario: course.played for scenario, course in courses.items()}


def committed(root: Group, lines: Sequence[Line]) -> tuple[Step, ...]:
    """What robots do by themselves as long as no scenarios are told apart."""
    steps: list[Step] = []
    group: Group | None = root
    while group is not None and group.choice is not None:
        steps += [Step(group.epoch + 1, action) for action in group.choice.robots.actions]
        branches = group.choice.branches
        group = branches[0][1] if len(branches) == 1 else None
    if group is not None and len(group.members) == 1:
        (at,) = group.members
        rest = lines[at.scenario].rest(at, group.epoch)
        robots = () if rest is None else (s for s in rest.steps if not lines[at.scenario].is_own(s.action))
        steps += [Step(step.epoch + group.epoch, step.action) for step in robots]
    return tuple(sorted(steps))
