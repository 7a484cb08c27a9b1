"""Whether what robots begin makes a way dearer that the person may be on, in time (semantics 10.6)."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import TypeVar

from serendipity.facade.person.follower import Follower
from serendipity.facade.person.ways import Way, Ways
from serendipity.model import Deadline, Task
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.execution import actions_named
from serendipity.model.task.passing import at_work, epoch_later

_Robot = TypeVar("_Robot")


def begun_of(robots: Sequence[_Robot], *, surely: bool) -> list[tuple[_Robot, ...]]:
    """What may have begun of all that robots are to begin: all of it, surely, or else only some."""
    sizes = (len(robots),) if surely else range(len(robots) + 1)
    return [some for size in sizes for some in combinations(robots, size)]


class Spoiling:
    """Somebody whom robots are not to hinder, and how things stand.

    Args:
        now: the task as it stands.
        mind: what they mean to do.
        ways: what they could do alone.
        strict: whether interference is strict.
        deadline: until then it has to be known.
    """

    def __init__(self, now: Task, mind: Follower, ways: Ways, *, strict: bool, deadline: Deadline) -> None:
        self._now = now
        self._mind = mind
        self._ways = ways
        self._strict = strict
        self._deadline = deadline

    def spoils(
        self, teams: Sequence[Sequence[GroundAction]], offers: Sequence[GroundAction], least: Fraction
    ) -> bool:
        """Whether what robots begin may make a way dearer, whichever of least cost it is.

        Args:
            teams: what they may begin by themselves.
            offers: what they may begin with the person.
            least: what the person pays alone.
        """
        for own in self._next_steps(offers):
            try:
                left = self._ways.of(self._later(own), self._deadline)
            except BrokenPlanError:
                continue
            if left is None or sum((a.cost for a in own), left.cost) > least:
                continue
            if any(self._worse([*own, *team], left) for team in teams):
                return True
        return self._mind.faithful and any(map(self._breaks, teams))

    def _breaks(self, team: Sequence[GroundAction]) -> bool:
        """Whether somebody who keeps to what they mean to do can't, if robots begin something."""
        now, mind, name = self._now, self._mind.copy(), self._mind.next
        mind.passed(name)
        ids = () if name is None else actions_named(now, name, [now.agents[now.human]])
        own = [action for action in (now.actions[i] for i in ids) if action.applicable(now.init)][:1]
        try:
            if mind.working(self._later(own)) is None:
                return False
            return mind.working(self._later([*own, *team])) is None
        except BrokenPlanError:
            return True

    def _next_steps(self, offers: Sequence[GroundAction]) -> Iterable[Sequence[GroundAction]]:
        """What the person may do in the epoch that is to come: go on or wait, or begin something."""
        yield ()
        now = self._now
        if now.human not in at_work(now):
            own = (now.actions[i] for i in now.human_actions)
            yield from ([action] for action in (*own, *offers) if action.applicable(now.init))

    def _worse(self, begun: Sequence[GroundAction], left: Way) -> bool:
        try:
            then = self._ways.of(self._later(begun), self._deadline)
        except BrokenPlanError:
            return True
        return then is None or then.cost > left.cost

    def _later(self, begun: Iterable[GroundAction]) -> Task:
        return epoch_later(self._now, begun, strict=self._strict)
