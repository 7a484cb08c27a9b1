"""What a local human sees, and believes of the rest (semantics 6, 10.6)."""

from collections.abc import Callable

from serendipity.model import Task, Visible, surroundings
from verify.base.execution import State, is_last


class LocalSight:
    """A local human's looks.

    Args:
        visible: what they see; None for what is where they are.
        tick: called every so often.
    """

    def __init__(self, task: Task, visible: Visible | None, tick: Callable[[], None]) -> None:
        self._task = task
        self._places = surroundings(task, tick)
        self._visible = visible or self._places.visible
        actions, names = task.actions, task.agents
        self._work = {
            fact: frozenset(actions[i].participants)
            for fact, i in task.due
            if not any(is_last(actions[j]) for (j, *_) in task.due_for[fact])
        }
        free = {task.facts[fact]: fact for fact in task.at_rest}
        self._free = {free[f"free {who}"]: i for i, who in enumerate(names) if f"free {who}" in free}

    def looked(self, belief: State, state: State) -> State:
        """A belief after a look at a state."""
        shown = self._shown(state) if self._task.due else frozenset[int]()
        seen = frozenset(fact for fact in state ^ belief if self._sees(fact, state, shown))
        over = frozenset[int]().union(*(self._work[f] for f in seen & belief & self._work.keys())) - shown
        return belief ^ seen | {fact for fact, agent in self._free.items() if agent in over}

    def _shown(self, state: State) -> frozenset[int]:
        """Whom the human sees, and with whom these are at something."""
        task, places = self._task, self._places
        near = places.near(task.human, state) if places.located else task.agents
        seen = {task.human, *task.script.people, *(i for i, who in enumerate(task.agents) if who in near)}
        busy = (self._work[fact] for fact in state & self._work.keys())
        return frozenset(seen).union(*(agents for agents in busy if not agents.isdisjoint(seen)))

    def _sees(self, fact: int, state: State, shown: State) -> bool:
        if self._task.in_time is None or fact < len(self._task.in_time.facts):
            return self._visible(self._task.human, fact, state)
        if fact in self._work:
            return not self._work[fact].isdisjoint(shown)
        return self._free.get(fact, self._task.human) in shown
