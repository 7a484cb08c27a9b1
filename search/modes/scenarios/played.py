"""What happens in a scenario: put together epoch by epoch (semantics 11)."""

from typing import NamedTuple

from search.engine.paths import plan_steps
from search.modes.scenarios.lines import Line, Way
from search.modes.scenarios.measure import OVER, Member
from search.modes.scenarios.variants import Variants
from search.packed.joint_actions import NOTHING, JointAction
from serendipity.model.task.plans import Step, Window


class Played(NamedTuple):
    """What everybody does in one scenario, and the window that interrupts the human's plan there, or None."""

    steps: tuple[Step, ...]
    window: Window | None


class Course:
    """A scenario as far as it has come."""

    def __init__(self, variants: Variants) -> None:
        self._shared = variants.shared
        self.steps: list[Step] = []
        self.start = self.end = 0

    def go_on(self, way: Way, at: Member, epoch: int, robots: JointAction = NOTHING) -> None:
        """An epoch from a place on."""
        self.steps += [Step(epoch, action) for action in (*self._shared(way.part.actions), *robots.actions)]
        if way.opens:
            self.start = epoch
        if way.after.phase == OVER and at.phase != OVER:
            self.end = epoch + 1

    def finish(self, line: Line, at: Member, epoch: int, *, certain: bool) -> None:
        """All that is left: the suffix, the ordinary call's plan, or the human's own."""
        rest = line.certain.known(at, epoch) if certain and at.phase != OVER else None
        if rest is not None:
            left = [step for step in rest.steps if step.epoch > epoch]
            ids = self._shared(step.action for step in left)
            self.steps += [Step(step.epoch, action) for step, action in zip(left, ids, strict=True)]
            if rest.window is not None:
                self.start, self.end = self.start or rest.window.start, rest.window.end
        else:
            self.steps += plan_steps(self._shared(line.left_alone(at, epoch)), epoch + 1)

    @property
    def played(self) -> Played:
        """All of it."""
        return Played(tuple(sorted(self.steps)), Window(self.start, self.end) if self.end else None)
