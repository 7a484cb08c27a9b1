"""What happens whatever is chosen: actions that go on, bystanders, and the clock (semantics "Time")."""

from collections.abc import Callable, Iterable, Iterator, Sequence

from search.packed.joint_actions import NOTHING, JointAction, as_option, together
from search.packed.operators import Operator, applicable, union
from search.packed.packed_task import PackedGoal, PackedTask

_ByName = dict[str, list[JointAction]]
"""What is due, by the names of actions: one of each name."""


class _Options:
    """What is due by field and value.  Fields of one bit, which are many, are told by what is set."""

    def __init__(self) -> None:
        self._bits = 0
        self._single: dict[int, _ByName] = {}
        self._wide: dict[int, dict[int, _ByName]] = {}

    def under(self, field: int, value: int) -> _ByName:
        """What is due at a value, to be added to."""
        if field == value and not field & (field - 1):
            self._bits |= field
            return self._single.setdefault(field, {})
        return self._wide.setdefault(field, {}).setdefault(value, {})

    def at(self, state: int) -> Iterator[list[JointAction]]:
        """What is due in a packed state, each in all its ways."""
        bits = state & self._bits
        while bits:
            lowest = bits & -bits
            yield from self._single[lowest].values()
            bits ^= lowest
        for field, by_value in self._wide.items():
            yield from by_value.get(state & field, {}).values()


class Due:
    """What is due in a packed state.

    Attributes:
        deciding: the fields that say what is due to others, and to the clock.
    """

    def __init__(self, packed: PackedTask, weight: Callable[[Operator], int], *, strict: bool) -> None:
        self._packed = packed
        self._weight = weight
        self._strict = strict
        self.deciding = union(field for field, _, op in packed.due if not op.agents & packed.human_bit)
        self._human = _Options()
        self._others = _Options()
        self._clock: dict[int, Operator] = {}
        self._clock_field = 0
        for field, value, op in packed.due:
            if op.agents == packed.clock_bit:
                self._clock_field = field
                self._clock[value] = op
            else:
                kind = self._human if op.agents & packed.human_bit else self._others
                by_name = kind.under(field, value)
                by_name.setdefault(packed.task.actions[op.action].name, []).append(as_option(op, weight(op)))

    def __bool__(self) -> bool:
        return bool(self._packed.due)

    def at(self, state: int) -> tuple[tuple[Operator, ...], tuple[Operator, ...]] | None:
        """What others have to do, and what the clock changes after it; None where nothing is due.

        Of what they may do in several ways it is the first.
        """
        theirs = [self._packed.op(ways[0].actions[0]) for ways in self._others.at(state)]
        last = self.last(state)
        return (tuple(theirs), () if last is None else (last,)) if theirs or last is not None else None

    def human(self, state: int) -> tuple[JointAction, ...] | None:
        """What the human is in the middle of, and has to go on with: nothing, where that is impossible.

        None where they are free to wait, or to begin something.
        """
        for variants in self._human.at(state):
            return self._possible(variants, state)
        return None

    def others(self, state: int) -> list[JointAction]:
        """What others have to do, as one set; no set where that is impossible."""
        found = NOTHING
        for variants in self._others.at(state):
            ways = self._possible(variants, state)
            if not ways or not self.fits(ways[0], found):
                return []
            found = together(found, ways[0])
        return [found]

    def pending(self, state: int) -> int:
        """What it adds to a key that others end what they are at."""
        packed = self._packed
        going_on = (variants[0] for variants in self._others.at(state))
        return sum(self._weight(op) for part in going_on for op in packed.chain(packed.op(part.actions[0])))

    def is_calm(self, state: int) -> bool:
        """Whether nothing happens from a state on unless somebody does it."""
        happens = (self.last(state), self.human(state), next(self._others.at(state), None))
        return happens == (None, None, None)

    def may_end(self, state: int, epoch: int, horizon: int | None) -> bool:
        """Whether a plan may end with an epoch: what has been reached is not lost again before ``T``.

        Without a horizon it ends wherever the goals hold.
        """
        return horizon is None or epoch == horizon or self.is_calm(state)

    def after(self, state: int, parts: Iterable[JointAction]) -> int | None:
        """The state after an epoch in which the human does the first of some things that is possible.

        Others do what is due; None where it is impossible.
        """
        for others in self.others(state):
            for part in parts:
                if self.fits(part, others):
                    return self.outcome(state, together(part, others))
        return None

    def after_all(self, state: int, plan: Iterable[int]) -> int | None:
        """The state after a plan of the human's own, an action an epoch; None where it is impossible."""
        for action in plan:
            after = self.after(state, (as_option(self._packed.op(action), 0),))
            if after is None:
                return None
            state = after
        return state

    def supposed(self, state: int, own: JointAction) -> int:
        """The same as somebody takes it to be who may be wrong: all goes on, whatever it asks."""
        done = own
        for variants in self._others.at(state):
            done = together(done, (self._possible(variants, state) or variants)[0])
        return self.outcome(state, done)

    def outcome(self, state: int, done: JointAction) -> int:
        """The state after an epoch in which all this is done, and the clock goes on."""
        after, last = state & done.keep | done.put, self.last(state)
        return after if last is None else after & last.keep | last.put

    def finished(self, state: int) -> tuple[int, int, tuple[int, ...]] | None:
        """The state in which the human has ended what they are at, what that weighs, its actions by epochs.

        None where they can't go on with it.
        """
        weight, actions = 0, list[int]()
        while (going_on := self.human(state)) is not None:
            after = self.after(state, going_on)
            if after is None:
                return None
            state = after
            weight += going_on[0].weight
            actions += going_on[0].actions
        return state, weight, tuple(actions)

    def lasting(self, state: int, epochs: int, goals: Iterable[PackedGoal]) -> bool:
        """Whether goals hold after some epochs of waiting from a state."""
        for _ in range(epochs):
            if self.is_calm(state):
                break
            going_on = self.human(state)
            after = self.after(state, (NOTHING,) if going_on is None else going_on)
            if after is None:
                return False
            state = after
        return all(goal.holds(state) for goal in goals)

    def last(self, state: int) -> Operator | None:
        """What the clock changes after all that is done; None once it has stopped."""
        return self._clock.get(state & self._clock_field)

    def with_last(self, options: Iterator[JointAction], state: int) -> Iterator[JointAction]:
        """Sets of actions, with what the clock changes after them."""
        last = self.last(state)
        if last is None:
            return options
        return (o._replace(keep=o.keep & last.keep, put=o.put & last.keep | last.put) for o in options)

    def _possible(self, variants: Sequence[JointAction], state: int) -> tuple[JointAction, ...]:
        return tuple(o for o in variants if applicable(self._packed.op(o.actions[0]), state))

    def fits(self, option: JointAction, others: JointAction) -> bool:
        """Whether an action (or none) may share an epoch with others (semantics 2)."""
        if option.agents & others.agents:
            return False
        for other in others.actions if option.actions else ():  # thrice as fast as a generator
            if not self._packed.compatible(option.actions[0], other, self._strict):
                return False
        return True


def as_one(packed: PackedTask, ops: Sequence[Operator]) -> Operator:
    """Ops of the human's that follow on each other, as one; one that no state allows where they can't."""
    first, *rest = ops
    need_mask, need, keep, put, forbidden = first[:5]
    for op in rest:
        asked = op.need_mask & keep
        ruled_out = any(put & field == value for field, value in op.forbidden if not field & keep)
        if ruled_out or (put ^ op.need) & op.need_mask & ~keep or (need ^ op.need) & need_mask & asked:
            field = next(packed.split(first.need_mask))  # it asks for a human who is free
            return first._replace(forbidden=((field, first.need & field),))
        forbidden += tuple((field, value) for field, value in op.forbidden if field & keep)
        need_mask, need = need_mask | asked, need | op.need & keep
        keep, put = keep & op.keep, put & op.keep | op.put
    for field in packed.split(need_mask & packed.all_ones & ~keep) if rest else ():
        if (need ^ put) & field == 0:  # the human is free again
            keep, put = keep | field, put & ~field
    return first._replace(need_mask=need_mask, need=need, keep=keep, put=put, forbidden=forbidden)
