"""What the person at the page knows: what they see now, and elsewhere what they saw last (semantics 6)."""

from serendipity.model import GroundAction, Task
from serendipity.model.task.actions import apply
from serendipity.model.task.visibility import surroundings


class Knowledge:
    """What a person takes to be true.

    Args:
        task: where it begins, which they know.
        view: ``observant`` sees everything; ``local`` what is where they are.

    Attributes:
        belief: ids of the facts that they take to be true.
    """

    def __init__(self, task: Task, view: str) -> None:
        self._human = task.human
        self._around = surroundings(task) if view == "local" else None
        self._all = range(len(task.facts))
        self._values = [frozenset(v.facts) for v in task.variables if not v.boolean]
        self.belief = task.init

    @property
    def everywhere(self) -> bool:
        """Whether they see everything."""
        return self._around is None or not self._around.located

    def sees(self, fact: int, state: frozenset[int]) -> bool:
        """Whether they see in a state if a fact is true."""
        return self._around is None or self._around.visible(self._human, fact, state)

    def look(self, state: frozenset[int], done: GroundAction | None) -> None:
        """Take in an epoch.

        Args:
            state: how things are now.
            done: what they did themselves, of which they know what it does.
        """
        if self._around is None or not self._around.located:
            self.belief = state
            return
        expected = self.belief if done is None else apply(self.belief, done)
        near = self._around.near(self._human, state)
        seen = {fact for fact in self._all if not self._around.parts[fact].isdisjoint(near)}
        known = state & seen
        for values in self._values:  # what is seen in one place is not in another one
            if not values.isdisjoint(known):
                expected -= values
        self.belief = (expected - seen) | known
