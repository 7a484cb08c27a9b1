"""What one scenario may do in an epoch beside robots: rules 1 to 3 of semantics 3.1 (semantics 11)."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from operator import attrgetter
from typing import NamedTuple

from search.modes.scenarios.measure import (
    FOLLOWING,
    INFINITE_WORTH,
    INSIDE,
    OVER,
    Measure,
    Member,
    Tail,
    Worths,
)
from search.modes.scenarios.remainder import Certain, Remainder, Scenario
from search.modes.scenarios.timetables import Timetable
from search.packed.cost_vector import INFINITE_KEY
from search.packed.joint_actions import NOTHING, JointAction, as_option, together
from search.packed.operators import Operator, applicable
from search.packed.successor_generator import Successors
from search.strategies.conditions import asks_for_nothing_else
from serendipity.model.resources.deadline import Deadline


class Move(NamedTuple):
    """What the human does, joint actions included, what the epoch is worth, and the state after it."""

    part: JointAction
    worth: int
    state: int


class Moves:
    """The moves of one task, for all scenarios that share it.

    Scenarios that are not told apart are in one state, so each asks for the same moves, one after another.
    """

    def __init__(self, successors: Successors, worths: Worths) -> None:
        self.successors = successors
        self._worths = worths
        self.fits = successors.due.fits
        self._asked: tuple[int, JointAction] = (-1, NOTHING)
        self._free: list[Move] = []

    def free(self, state: int, beside: JointAction) -> Sequence[Move]:
        """All that the human may do where they follow no plan."""
        if self._asked != (state, beside):
            parts = (part for part in self.successors.free(state) if self.fits(part, beside))
            self._free = [self.together(state, part, beside) for part in parts]
            self._asked = state, beside
        return self._free

    def together(self, state: int, part: JointAction, beside: JointAction) -> Move:
        """What the human does, beside all that others do."""
        done = together(part, beside)
        return Move(part, self._worths.of_key(done.weight), self.successors.due.outcome(state, done))


class Way(NamedTuple):
    """What a scenario does in an epoch.

    Attributes:
        part: the human's, joint actions included.
        paid: what the epoch is worth.
        after: the scenario after it.
        opens: whether the window opens with it.
    """

    part: JointAction
    paid: int
    after: Member
    opens: bool


class Guide(NamedTuple):
    """A plan for one scenario that says what is done while others are possible, too.

    Attributes:
        line: the scenario's.
        remainder: the plan, its steps in order.
        phase: of the window at that time.
    """

    line: "Line"
    remainder: Remainder
    phase: int

    def at(self, epoch: int) -> tuple[JointAction, tuple[int, ...], int]:
        """What robots begin by themselves in an epoch, what the human does, and the phase after it."""
        packed, weight = self.line.context.packed, self.line.context.weights.team
        steps, of = self.remainder.steps, attrgetter("epoch")
        begun = steps[bisect_left(steps, epoch, key=of) : bisect_right(steps, epoch, key=of)]
        ops = [packed.op(step.action) for step in begun]
        robots = NOTHING
        for op in ops:
            if not op.agents & packed.human_bit and packed.counted(op.action):
                robots = together(robots, as_option(op, weight(op)))
        robots = robots._replace(actions=self.line.variants.shared(robots.actions))
        part = tuple(op.action for op in ops if op.agents & packed.human_bit)
        window = self.remainder.window
        if window is None or epoch < window.start:
            return robots, part, self.phase
        return robots, part, INSIDE if epoch + 1 < window.end else OVER


class Line:
    """The epochs of one scenario."""

    def __init__(self, scenario: Scenario, number: int, moves: Moves, worths: Worths) -> None:
        context, options = scenario.context, scenario.context.options
        self.certain = Certain(scenario, worths)
        self.number = number
        self.variants = scenario.variants
        self._moves, self._acting = moves, moves.successors
        self._worths = worths
        self.context = context
        self._steps, self._suffix = self.certain.steps, self.certain.suffix
        self._suffixes: dict[tuple[int, int, int], Sequence[tuple[Operator, JointAction]]] = {}
        self._horizon = scenario.horizon
        self._max_window = self.certain.max_window
        self._timetable: Timetable | None = None
        self._openings: dict[tuple[int, int], int] = {}
        self._tells_starts = options.preservation == "state" or self._max_window < scenario.horizon

    def first(self) -> Member:
        """Before the first epoch."""
        return Member(self.number, self.context.packed.init, FOLLOWING, 0, None, 0)

    # -- what may happen

    def ways(
        self,
        at: Member,
        epoch: int,
        robots: JointAction,
        most: int = INFINITE_WORTH,
        only: tuple[int, ...] | None = None,
    ) -> Iterator[Way]:
        """What may happen in an epoch, counted from 1, in which robots begin so much by themselves.

        Args:
            at: before the epoch.
            most: what can't be had for less, from here to the end, may be left out.
            only: in a window, the actions of the human's that are looked at; None: all.
        """
        own = self.variants.own(robots, at.state)
        beside = None if own is None else self._acting.with_due(own, at.state)
        if beside is None:
            return
        if at.phase == OVER:
            if not robots.actions:
                yield from self._end(at, beside)
            return
        if at.phase == FOLLOWING:
            part = self._planned(at.state, epoch)
            if part is not None and self._moves.fits(part, beside):
                move = self._moves.together(at.state, part, beside)
                yield Way(move.part, move.worth, at._replace(state=move.state), False)
            if epoch > len(self._steps) or self._opening(at.state, epoch) >= most:
                return
        opens = at.phase == FOLLOWING
        start = epoch if opens and self._tells_starts else at.start
        inside = at._replace(start=start, phase=INSIDE)
        for move in self._moves.free(at.state, beside):
            if only in (None, move.part.actions):
                yield from self._within(inside, epoch, move, opens, most)

    def _opening(self, state: int, epoch: int) -> int:
        """A bound on what is left if a window opens in an epoch."""
        known = self._openings.get((state, epoch))
        if known is None:
            window, of_key = self._worths.epoch, self._worths.of_key
            known = min(self._rest(state) + window, INFINITE_WORTH)
            if self._timetable is not None:
                at_once = of_key(self._timetable.least(epoch - 1, state, at_once=True)) + window
                known = max(known, min(at_once, known + window))
            self._openings[state, epoch] = known
        return known

    def _rest(self, state: int) -> int:
        """A bound on what is left to pay, without windows."""
        return self._worths.of_key(max(self.context.bound(state), self.context.team_bound(state)))

    def _planned(self, state: int, epoch: int) -> JointAction | None:
        """Rule 1; beyond the end of their plan they wait."""
        if epoch > len(self._steps):
            return NOTHING
        op, part = self._steps[epoch - 1]
        return part if applicable(op, state) else None

    def _end(self, at: Member, beside: JointAction) -> Iterator[Way]:
        assert at.tail is not None, "it has begun"
        part, rest = NOTHING, self._suffix_steps(at.tail)
        if rest:
            op, part = rest[0]
            if not applicable(op, at.state):
                return
        move = self._moves.together(at.state, part, beside)
        after = at.tail._replace(done=at.tail.done + 1)
        yield Way(part, move.worth, at._replace(state=move.state, tail=after), False)

    def _within(self, at: Member, epoch: int, move: Move, opens: bool, most: int) -> Iterator[Way]:
        """Rules 2 and 3: the window goes on after the epoch, or is over."""
        part, state, paid = move.part, move.state, move.worth + self._worths.epoch
        start, left = at.start or epoch, self._horizon - epoch
        limit = self._worths.key(most - paid) if most < INFINITE_WORTH else INFINITE_KEY
        if self._suffix.key(state, left, start, limit) < limit:
            tail = Tail(state, left, start, 0)
            yield Way(part, paid, Member(self.number, state, OVER, 0, tail, at.ahead), opens)
        least = paid + self._worths.epoch
        may_last = left and (not at.start or epoch - at.start + 1 < self._max_window) and least < most
        if may_last and least + self._worths.of_key(self.context.bound(state)) < most:
            yield Way(part, paid, at._replace(state=state), opens)

    def worth(self, robots: JointAction) -> int:
        """What a set of robots' actions is worth."""
        return self._worths.of_key(robots.weight)

    def begun(self, state: int) -> Iterable[JointAction]:
        """What robots may begin by themselves, cheapest first."""
        return self.variants.offered(self._acting.begun(state))

    def seen(self, way: Way) -> tuple[str | None, object]:
        """What robots see of a way; other variants of a name may do other things."""
        return self._acting.name(way.part), self.variants.seen(way.after.state)

    def _suffix_steps(self, tail: Tail) -> Sequence[tuple[Operator, JointAction]]:
        """What is left of a suffix; it is put together when it is asked for first."""
        begun = tail[:3]
        if begun not in self._suffixes:
            self._suffixes[begun] = self.context.followed(self._suffix.actions(*begun))
        return self._suffixes[begun][tail.done :]

    # -- what is left

    def guide(self, at: Member, epoch: int, deadline: Deadline | None) -> Guide | None:
        """The best plan known for what is left, if this is what the human does for certain.

        Args:
            deadline: of an ordinary call, where there was none; None: there is none.
        """
        certain, found = self.certain, self.certain.known(at, epoch)
        if deadline is not None:
            found = certain.remainder(at, epoch, deadline, again=False)
        if found is None or found.worth >= INFINITE_WORTH:
            return None
        found = found._replace(steps=tuple(sorted(found.steps)))
        return Guide(self, found, at.phase)

    def raise_floor(self, way: Way, epoch: int, least: int) -> None:
        """Note that nothing less is left to pay before an epoch in which something is done."""
        if way.after.phase != OVER:
            self.certain.raise_floor(way.after, epoch, least - way.paid)

    def least(self, at: Member, epoch: int) -> int:
        """A bound that is had at once on what is left to pay after an epoch."""
        if at.tail is not None:
            if not at.tail.done:
                return self._worths.of_key(self._suffix.key(*at.tail[:3], INFINITE_KEY))
            return sum(self._worths.of_key(part.weight) for _, part in self._suffix_steps(at.tail))
        if epoch == self._horizon:  # exact, whatever bound was handed on
            done = at.phase == FOLLOWING and all(goal.holds(at.state) for goal in self.context.goals)
            return self._worths.epoch if done else INFINITE_WORTH
        window, of_key = self._worths.epoch, self._worths.of_key
        known = self.certain.floor(at, epoch)
        found = self.certain.known(at, epoch)
        if found is not None and found.least >= found.worth:
            return known
        least = min(self._rest(at.state) + window, INFINITE_WORTH)
        if at.phase == FOLLOWING and self._timetable is not None:
            beside = of_key(self._timetable.least(epoch, at.state)) + window
            alone = of_key(sum(part.weight for _, part in self._steps[epoch:])) + window
            least = max(least, min(beside, alone, least + window))
        return max(least, known)

    def is_tabulated(self, *, wholly: bool) -> bool:
        """Whether states beside the human's plan are bounded, or all of them that may be of interest."""
        table = self._timetable
        return table is not None and (table.is_whole if wholly else table.is_there)

    def tabulate(self, least: int, limit: int, deadline: Deadline) -> None:
        """Bound states beside the human's plan, where only a window of one epoch can be worth so little.

        Args:
            least: bound on the scenario.
            limit: what is worth as much or more is of no interest.
            deadline: what is there by then is taken.
        """
        epoch, context, key = self._worths.epoch, self.context, self._worths.key
        if not asks_for_nothing_else(context) or least >= limit:
            return
        if limit <= 2 * epoch + self._worths.of_key(context.bound(context.packed.init)):
            steps = [op for op, _ in self._steps]
            self._timetable = Timetable(context, steps, key(least - epoch), key(limit - epoch), deadline)
            self._openings.clear()

    def left_alone(self, at: Member, epoch: int) -> tuple[int, ...]:
        """What the human does after an epoch if nobody helps: their suffix, or the rest of their plan."""
        steps = self._steps[epoch:] if at.tail is None else self._suffix_steps(at.tail)
        return tuple(op.action for op, _ in steps)

    def learn(self, at: Member, epoch: int, way: Way, robots: JointAction) -> None:
        """Note what is left after an epoch, if the best plan known was followed in it."""
        before, after = self.certain.known(at, epoch - 1), way.after
        if before is None or after.phase == OVER:
            return
        shared, inside = self.variants.shared, after.phase == INSIDE
        begun = {*shared(step.action for step in before.steps if step.epoch == epoch)}
        done = {*shared(way.part.actions), *robots.actions}
        as_planned = all(not self.variants.begins(action) for action in begun ^ done)
        if as_planned and before.goes_on(epoch, inside=inside):
            self.certain.learn(after, epoch, before.after(way.paid))

    def certainly(
        self, at: Member, epoch: int, deadline: Deadline, most: int = INFINITE_WORTH, *, again: bool = True
    ) -> tuple[int, int]:
        """Bound and worth of what is left, if this is what the human does for certain.

        Args:
            at: after the epoch.
            deadline, most, again: see :meth:`.Certain.remainder`.
        """
        if at.phase == OVER or epoch == self._horizon:
            rest = self.least(at, epoch)
            return rest, rest
        found = self.certain.remainder(at, epoch, deadline, most, again=again)
        return found.least, found.worth


def undominated(
    lines: Sequence[Line], each: Sequence[Sequence[tuple[int, Way]]]
) -> list[list[tuple[int, Way]]]:
    """Ways of each scenario with bounds, cheapest first, without ends of windows that leave nobody more room.

    What robots see of an end only matters to scenarios that may look the same, and go on.
    """
    seen = [[lines[way.after.scenario].seen(way) for _, way in ways] for ways in each]
    goes_on = [
        {look for look, (_, way) in zip(looks, ways, strict=True) if way.after.phase != OVER}
        for looks, ways in zip(seen, each, strict=True)
    ]
    found = []
    for i, (looks, ways) in enumerate(zip(seen, each, strict=True)):
        alike = set[object]().union(*goes_on[:i], *goes_on[i + 1 :])
        kept, best = list[tuple[int, Way]](), INFINITE_WORTH
        for look, (bound, way) in sorted(zip(looks, ways, strict=True), key=lambda one: one[1][0]):
            if way.after.phase != OVER or bound < best or not kept:
                kept.append((bound, way))
            if way.after.phase == OVER and look not in alike:
                best = min(best, bound)
        found.append(kept)
    return found


class Question(NamedTuple):
    """What a search over scenarios is asked.

    Attributes:
        lines: the scenarios' epochs.
        members: all scenarios, before the first epoch.
    """

    lines: Sequence[Line]
    members: tuple[Member, ...]
    measure: Measure
    horizon: int
    deadline: Deadline

    def value(self, rests: Sequence[int]) -> int:
        """What it is worth if each scenario has so much to pay."""
        return self.measure.value(self.members, rests)
