"""What the human can do alone, beside what happens anyway."""

from collections.abc import Callable, Iterator

from search.packed.due import Due
from search.packed.joint_actions import JointAction, as_option, together
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from search.packed.successor_generator import Lookup


class BesideScript(Lookup):
    """The human's options, each with what bystanders do in its epoch, and with what the clock changes."""

    def __init__(self, packed: PackedTask, weight: Callable[[Operator], int], *, strict: bool) -> None:
        super().__init__(packed.own_index, weight)
        self._due = Due(packed, weight, strict=strict)
        waits = [packed.op(action) for action in packed.idling if not packed.prices_waiting]
        self._waiting = [as_option(op, weight(op)) for op in waits]  # else it is in the index

    def options(self, state: int) -> list[JointAction]:
        """What is possible in a packed state."""
        going_on = self._due.human(state)
        found = super().options(state) if going_on is None else [*going_on]
        others = self._due.others(state)
        if self._due.last(state) is None and others and not others[0].actions:
            return found
        if going_on is None:
            found += self._waiting
        return list(self._due.with_last(self._beside(found, others), state))

    def _beside(self, found: list[JointAction], others: list[JointAction]) -> Iterator[JointAction]:
        for theirs in others:
            for option in found:
                if self._due.fits(option, theirs):
                    yield together(option, theirs)._replace(weight=option.weight)
