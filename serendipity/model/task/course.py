"""The course of a plan, epoch by epoch: durations, and the script beside it (semantics 10).

Written once for everything around the planner.  Whoever judges plans (the verifier, the brute force
of the tests) has code of its own.
"""

from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from itertools import combinations

from serendipity.model.task.actions import Condition, GroundAction, conflicting
from serendipity.model.task.script import Timeline


class BrokenPlanError(Exception):
    """Something can't go on as it should; its text says why, for people."""

    def __init__(self, action: GroundAction, reason: str) -> None:
        self.action = action
        self.reason = reason
        super().__init__(f"'{action.name}' {reason}")


@dataclass(slots=True)
class _Going:
    """An action under way, and the epochs that it still takes."""

    action: GroundAction
    left: int


class PlayedPlan:
    """The states of a plan: each epoch is told what begins in it.

    Attributes:
        epoch: the last one that is over; 0 at first.
        state: after it.
        begun: what began in it, by bystanders too.
    """

    def __init__(
        self, facts: Sequence[str], init: frozenset[int], script: Timeline, *, strict: bool = False
    ) -> None:
        self.epoch = 0
        self.state = init
        self.begun: list[GroundAction] = []
        self._facts = facts
        self._script = script
        self._strict = strict
        self._going: list[_Going] = []

    def begin(self, actions: Iterable[GroundAction]) -> None:
        """Let the next epoch go by, with some actions that begin in it.

        Raises:
            BrokenPlanError: an action can't begin, go on or end there, or two are in each other's way.
        """
        self.epoch += 1
        for going in self._going:
            assert going.action.timing is not None
            self._ask(going.action.timing.over_all, going.action, "can't go on")
        self.begun = begun = [*actions, *self._deeds()]
        for action in begun:
            self._ask(action.precondition, action, "is not applicable")
        self._require_free(begun)
        self._going += [_Going(action, action.duration) for action in begun]
        changes = [self._change(going) for going in self._going]
        self._require_undisturbed(changes)
        self.state = self.state.difference(*[change.delete for change in changes])
        self.state = self.state.union(*[change.add for change in changes])
        true, false = self._script.changes(self.epoch)
        self.state = (self.state - false) | true
        for going in self._going:
            going.left -= 1
        self._going = [going for going in self._going if going.left]

    def rest(self, until: int) -> int:
        """Let epochs go by, to ``until`` at most, while nothing goes on and nothing happens; how many."""
        if self._going:
            return 0
        calm = self._script.calm_until(self.epoch)
        passed = max(0, (until if calm is None else min(calm, until)) - self.epoch)
        self.epoch += passed
        return passed

    @property
    def going(self) -> Iterator[tuple[GroundAction, int]]:
        """The actions that have not ended yet, and how many epochs they still take."""
        return ((going.action, going.left) for going in self._going)

    def under_way(self) -> Iterator[GroundAction]:
        """Those of the plan's; those of bystanders don't count."""
        people = self._script.people
        return (going.action for going in self._going if people.isdisjoint(going.action.participants))

    def _deeds(self) -> list[GroundAction]:
        return [
            next((one for one in deed.variants if one.applicable(self.state)), deed.variants[0])
            for deed in self._script.begun(self.epoch)
        ]

    def _require_free(self, begun: Sequence[GroundAction]) -> None:
        """Check that everybody who begins something is at nothing else."""
        busy = {agent: going.action for going in self._going for agent in going.action.participants}
        for action in begun:
            for agent in action.participants:
                if agent in busy:
                    raise BrokenPlanError(
                        action, f"can't begin in epoch {self.epoch}: '{busy[agent].name}' goes on"
                    )
                busy[agent] = action

    def _change(self, going: _Going) -> GroundAction:
        """What takes effect of an action in this epoch, with what has to hold before it."""
        action, timing = going.action, going.action.timing
        if timing is None:
            return action
        start, end = action.moments
        if going.left == timing.duration:
            return start
        if going.left > 1:
            inside = timing.over_all
            return GroundAction(action.name, action.participants, inside.positive, inside.negative, (), ())
        self._ask(timing.at_end, action, "can't end")
        return end

    def _require_undisturbed(self, changes: Sequence[GroundAction]) -> None:
        for a, b in combinations([change for change in changes if change.add or change.delete], 2):
            if conflicting(a, b, strict=False):
                raise BrokenPlanError(a, f"and '{b.name}' change the same fact in epoch {self.epoch}")
        for a, b in combinations(changes, 2) if self._strict else ():
            if conflicting(a, b, strict=True):
                raise BrokenPlanError(a, f"and '{b.name}' disturb each other in epoch {self.epoch}")

    def _ask(self, condition: Condition, action: GroundAction, words: str) -> None:
        unmet = first_unmet(condition, self.state, self._facts)
        if unmet is not None:
            raise BrokenPlanError(action, f"{words}: {unmet}")


class SupposedPlan(PlayedPlan):
    """The same as somebody takes it to be who may be wrong: all goes on, whatever it asks."""

    def _require_free(self, begun: Sequence[GroundAction]) -> None:
        """They may be wrong about that."""

    def _require_undisturbed(self, changes: Sequence[GroundAction]) -> None:
        """They may be wrong about that."""

    def _ask(self, condition: Condition, action: GroundAction, words: str) -> None:
        """They may be wrong about that."""


def first_unmet(condition: Condition, state: AbstractSet[int], facts: Sequence[str]) -> str | None:
    """The first literal of a condition that does not hold in a state, in words; None where all do."""
    missing = next((f for f in condition.positive if f not in state), None)
    if missing is not None:
        return f"'{facts[missing]}' is false"
    wrong = next((f for f in condition.negative if f in state), None)
    return None if wrong is None else f"'{facts[wrong]}' is true"
