"""Search for a better policy over scenarios (semantics 11), independent of ``search``.

Scenarios that are not told apart are a *group*.  In each epoch robots do something by themselves, the same in
the whole group, and what the human does divides it; where robots see nothing it stays whole.  The search goes
depth first, and keeps the least value of each group once it is known, or a bound that it is not below.  No
group is worth less than its scenarios one by one, each a group of its own, and these no less than what is
left to pay by distances in the human's automaton.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from serendipity.model import Step
from verify.base.execution import grouped
from verify.base.fact_bits import BitOperator
from verify.base.undecided import UndecidedError
from verify.calls.call import ExaminedCall
from verify.limits import limits
from verify.programs.effort import Attempt
from verify.scenarios.courses import INFINITE, OVER, Course, JointMoves, PossibleScenario, Seen
from verify.scenarios.measure import Measure
from verify.scenarios.timelines import ScenarioTimeline

Group = tuple[int, tuple[PossibleScenario, ...]]
"""Scenarios that are not told apart, and after how many epochs."""


Better = tuple[int, tuple[Step, ...]]
"""The value of a policy that is better than the one asked about, and what robots do until they see more."""


class _Choice(NamedTuple):
    """What a scenario may do in an epoch: a bound on what it contributes then, of which so much is paid."""

    bound: int
    paid: int
    seen: Seen
    after: PossibleScenario


class PolicyEnumeration:
    """All policies over the scenarios of one answer: a call for each, and what the answer says of it."""

    def __init__(
        self, calls: Sequence[ExaminedCall], measure: Measure, lines: Sequence[ScenarioTimeline] = ()
    ) -> None:
        originals = [line.original for line in lines] or [()] * len(calls)
        prices = [line.prices for line in lines] or [{}] * len(calls)
        self._measure, self._watching = measure, calls[0].options.policy == "watching"
        self._effort, self._horizon = calls[0].effort, int(calls[0].horizon)
        moves: dict[int, JointMoves] = {}
        for call, original in zip(calls, originals, strict=True):
            moves.setdefault(id(call.task.actions), JointMoves(call, measure.pay, original))
        self._moves = [moves[id(call.task.actions)] for call in calls]
        self._courses = [
            Course(call, own, measure, priced)
            for call, own, priced in zip(calls, self._moves, prices, strict=True)
        ]
        starts = [own.bits.of(call.task.init) for call, own in zip(calls, self._moves, strict=True)]
        each = zip(starts, measure.ahead, strict=True)
        self._first = [PossibleScenario(k, init, ahead=ahead) for k, (init, ahead) in enumerate(each)]
        self._known: dict[Group, tuple[int, bool]] = {}
        self._chosen: dict[Group, tuple[BitOperator, list[Group]]] = {}
        self._most: list[int] = []
        self._looked_at = 0

    def better(self, than: int) -> Better | None:
        """The best policy of a value below ``than``; None: proved that there is none."""
        floors = self._measure.floors
        self._most = [self._measure.room(than, floors, k) - at.ahead for k, at in enumerate(self._first)]
        shift, root = _levelled(0, self._first)
        try:
            value = self._value(root, than - shift)
        except RecursionError:
            raise UndecidedError("the plans are too long to look at every policy") from None
        self._effort.attempts.append(Attempt("policies", decided=True, states=self._looked_at))
        return None if value is None else (value + shift, tuple(self._until_told_apart(root)))

    def _until_told_apart(self, group: Group) -> Iterator[Step]:
        following = [group]
        while len(following) == 1 and following[0] in self._chosen:
            robots, after = self._chosen[following[0]]
            yield from (Step(following[0][0] + 1, i) for i in robots.label)
            following = after

    # -- groups

    def _value(self, group: Group, below: int) -> int | None:
        """The least value of what a group has left to pay, if it is below so much."""
        epoch, members = group
        least, exact = self._known.get(group, (None, False))
        if least is None:
            least, exact = self._bound(epoch, members), epoch == self._horizon
            self._known[group] = least, exact
        if exact or least >= below:
            return least if least < below else None
        asked = below
        if len(members) == 1 and least > self._bound(epoch, members):  # asked before: now once and for all
            below = max(below, self._most[members[0].scenario])
        self._look()
        found = self._least(group, below)
        self._known[group] = (below, False) if found is None else (found, True)
        return found if found is not None and found < asked else None

    def _bound(self, epoch: int, members: Sequence[PossibleScenario]) -> int:
        return min(INFINITE, self._measure.joined(self._simple(epoch, at) for at in members))

    def _simple(self, epoch: int, at: PossibleScenario) -> int:
        """A bound on what a scenario contributes, had at once."""
        return self._measure.shares[at.scenario] * self._courses[at.scenario].least(at, epoch) + at.ahead

    def _single(self, epoch: int, at: PossibleScenario, below: int) -> int | None:
        """What a scenario contributes if robots know it to be this one, and if that is below so much."""
        level = at._replace(ahead=0) if at.ahead else at
        value = self._value((epoch, (level,)), below - at.ahead)
        return None if value is None else value + at.ahead

    def _least(self, group: Group, below: int) -> int | None:
        """The least value of a group by all that can be done in its next epoch."""
        epoch, members = group
        rests = [self._simple(epoch, at) for at in members]
        for k, at in enumerate(members if len(members) > 1 else ()):
            rest = self._single(epoch, at, self._measure.room(below, rests, k))
            if rest is None:
                return None
            rests[k] = rest
        best = below
        for robots in self._robots(members):
            choices = []
            for k, at in enumerate(members):
                found = list(self._choices(epoch + 1, at, robots[k], self._measure.room(best, rests, k)))
                if not found:
                    break
                choices.append(sorted(found, key=lambda choice: choice.bound))
            else:
                best = self._combined(group, robots[0], choices, best)
        return best if best < below else None

    def _robots(self, members: Sequence[PossibleScenario]) -> Iterator[tuple[BitOperator, ...]]:
        """What robots may do by themselves in the whole group, in each of its scenarios."""
        possible = [self._moves[at.scenario].robots(at.state) for at in members]
        idle = any(at.phase == OVER for at in members)
        for shared in [()] if idle else possible[0]:
            if all(shared in sets for sets in possible):
                yield tuple(sets[shared] for sets in possible)

    def _choices(
        self, epoch: int, at: PossibleScenario, robots: BitOperator, below: int
    ) -> Iterator[_Choice]:
        """What a scenario may do in an epoch and still contribute less than so much."""
        share = self._measure.shares[at.scenario]
        for seen, spent, after in dict.fromkeys(self._courses[at.scenario].ways(at, epoch, robots)):
            paid = share * spent
            if not self._measure.is_mean:
                after, paid = after._replace(ahead=at.ahead + spent), 0
            rest = self._single(epoch, after, below - paid)
            if rest is not None:
                yield _Choice(paid + rest, paid, seen, after)

    # -- what all do together

    def _combined(
        self, group: Group, robots: BitOperator, choices: Sequence[Sequence[_Choice]], below: int
    ) -> int:
        """The least value by any choice for each scenario, or ``below`` if none is less."""
        measure, best = self._measure, below
        least = [each[0].bound for each in choices]

        def extended(chosen: list[_Choice]) -> None:
            nonlocal best
            k = len(chosen)
            if k == len(choices):
                best = self._divided(group, robots, chosen, best)
                return
            before = [choice.bound for choice in chosen]
            for choice in choices[k]:
                if measure.joined((*before, choice.bound, *least[k + 1 :])) >= best:
                    break
                extended([*chosen, choice])

        extended([])
        return best

    def _divided(self, group: Group, robots: BitOperator, chosen: Sequence[_Choice], below: int) -> int:
        """The value of a choice for each scenario, or ``below`` if that is no less."""
        self._look()
        measure, epoch = self._measure, group[0] + 1
        parts = grouped((choice.seen if self._watching else True, choice) for choice in chosen)
        values = [measure.joined(choice.bound for choice in part) for part in parts.values()]
        groups = []
        for k, part in enumerate(parts.values()):
            shift, after = _levelled(epoch, [choice.after for choice in part])
            shift += sum(choice.paid for choice in part)
            value = self._value(after, self._measure.room(below, values, k) - shift)
            if value is None:
                return below
            values[k] = value + shift
            groups.append(after)
        self._chosen[group] = robots, groups
        return measure.joined(values)

    def _look(self) -> None:
        """Count a group, or what one may do."""
        self._looked_at += 1
        self._effort.deadline.check()
        if self._looked_at > limits().policies:
            raise UndecidedError(f"more than {limits().policies:,} groups of scenarios and what they do")


def _levelled(epoch: int, members: Sequence[PossibleScenario]) -> tuple[int, Group]:
    """A group, and what all its scenarios are ahead, which is left out of it."""
    shift = min(at.ahead for at in members)
    return shift, (epoch, tuple(at._replace(ahead=at.ahead - shift) for at in members))
