"""Actions of scenarios that have tasks of their own, and of the one that they share (semantics 12 to 14).

Rules of help make several of an action, of which a state allows one; robots do the same in all scenarios.
"""

from collections.abc import Iterable, Sequence

from search.call.context import SearchContext
from search.packed.joint_actions import NOTHING, JointAction, as_option, together
from search.packed.operators import applicable


class Variants:
    """Of one scenario.

    Args:
        original: by action that of the shared task; empty where they are the same.
        facts: how many of the shared task tell states apart; None where all facts do.
    """

    def __init__(self, context: SearchContext, original: Sequence[int], facts: int | None) -> None:
        self._context, self._original = context, original
        self._ids: dict[int, list[int]] = {}
        for new, number in enumerate(original):
            self._ids.setdefault(number, []).append(new)
        bits = context.packed.fact_bits[:facts] if facts is not None else []
        self._facts = [found for found in bits if found is not None]

    def shared(self, actions: Iterable[int]) -> tuple[int, ...]:
        """Actions of the scenario by ids of the shared task."""
        return tuple(self._original[i] for i in actions) if self._original else tuple(actions)

    def begins(self, action: int) -> bool:
        """Whether an action of the shared task is one that somebody begins by choice."""
        return bool(self._context.packed.counted(self._ids[action][0] if self._original else action))

    def offered(self, options: Iterable[JointAction]) -> Iterable[JointAction]:
        """What robots may begin, by ids of the shared task."""
        if not self._original:
            return options
        return (one._replace(actions=self.shared(one.actions)) for one in options)

    def own(self, robots: JointAction, state: int) -> JointAction | None:
        """What robots begin, by ids of the scenario; None where its state does not allow it."""
        packed, found = self._context.packed, NOTHING
        for action in robots.actions:
            ops = (packed.op(i) for i in (self._ids[action] if self._original else (action,)))
            op = next((op for op in ops if applicable(op, state)), None)
            if op is None:
                return None
            if self._original:
                found = together(found, as_option(op, self._context.weights.team(op)))
        return found if self._original else robots

    def seen(self, state: int) -> object:
        """What scenarios that are not told apart have in common of a state."""
        return tuple(state & mask == value for mask, value in self._facts) if self._facts else state
