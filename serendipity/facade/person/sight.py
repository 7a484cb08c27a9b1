"""What somebody in time sees from where they are, and takes the rest to be (semantics 6, 10.6)."""

from collections.abc import Iterable

from serendipity.model import Task, surroundings
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.passing import as_seen, supposed_later


class Sight:
    """How the human believes a task to stand.

    Args:
        task: the task as it stands at first, which they know.

    Attributes:
        believed: the task as they believe it to stand.
    """

    def __init__(self, task: Task) -> None:
        self.believed = task
        self._places = surroundings(task)

    def look(self, now: Task) -> tuple[tuple[int, bool], ...]:
        """They look up; what they find other than expected, and how."""
        human, expected = now.human, self.believed.init
        near = self._places.near(human, now.init) if self._places.located else now.agents
        agents = frozenset((human, *(i for i, name in enumerate(now.agents) if name in near)))
        self.believed = as_seen(
            self.believed, now, lambda fact: self._places.visible(human, fact, now.init), agents
        )
        found = self.believed.init
        return tuple((fact, fact in found) for fact in sorted(expected ^ found))

    def is_right(self, now: Task) -> bool:
        """Whether a task stands as they believe."""
        mine, true = self.believed.script, now.script
        same_work = frozenset(mine.deeds) == frozenset(true.deeds)
        return self.believed.init == now.init and mine.facts == true.facts and same_work

    def learn(self, tried: GroundAction, now: Task) -> None:
        """They have tried something in vain: they know whether what it asks for holds."""
        asked = {*tried.pre, *tried.neg}
        self.believed = self.believed.at((self.believed.init - asked) | (now.init & asked))

    def passed(self, begun: Iterable[GroundAction]) -> None:
        """An epoch is over, in which they began something."""
        self.believed = supposed_later(self.believed, begun)
