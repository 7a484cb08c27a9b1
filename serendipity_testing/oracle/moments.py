"""Time by brute force: an action of several epochs as a part for each of them (semantics 10).

A part asks what has to hold before its epoch, and does what takes effect in it: the first has the conditions
and effects at start, the last those at end, and all but the first ask for what holds over all.
"""

from collections.abc import Collection, Iterable, Iterator
from functools import cache
from itertools import combinations
from typing import NamedTuple

from serendipity.model import GroundAction, Task
from serendipity_testing.oracle.epochs import State, after, compatible, holds, parts_of, usable
from serendipity_testing.oracle.noticing import FRESH, Happening, Notices, Noticing

Going = tuple[tuple[int, int], ...]
"""What is under way, ascending: numbers of actions, each with how many of its parts are over."""


class Moment(NamedTuple):
    """Where things stand between two epochs.

    Attributes:
        state: the facts that are true.
        going: what is under way.
        retired: whether the human begins nothing any more, so that waiting costs them nothing.
        noticing: what is news to them, where that counts.
    """

    state: State
    going: Going = ()
    retired: bool = False
    noticing: Noticing = FRESH


class OracleWorld:
    """What may happen in an epoch of a task, bystanders and the script included.

    Args:
        task: the task.
        strict: whether interference is strict.
        notices: what the human notices, where that counts.

    Attributes:
        settled: the epoch after which nothing depends on the epoch any more.
    """

    def __init__(self, task: Task, *, strict: bool = False, notices: Notices | None = None) -> None:
        self.task = task
        self._notices = notices
        self.settled = task.script.last
        deeds = [action for deed in task.script.deeds for action in deed.variants]
        self._numbers = {id(action): len(task.actions) + i for i, action in enumerate(deeds)}
        self._who = [frozenset(action.participants) for action in (*task.actions, *deeds)]
        self._parts = [parts_of(action) for action in (*task.actions, *deeds)]
        self._strict = strict
        self._share = cache(self._may_share)

    def sets(
        self, moment: Moment, epoch: int, candidates: Iterable[int]
    ) -> Iterator[tuple[tuple[int, ...], Moment]]:
        """Every set of actions that can begin in an epoch, with where it leads."""
        forced = self._forced(moment, epoch)
        if forced is None:
            return
        ready = [i for i in candidates if self._begins(i, moment, forced)]

        def extend(chosen: tuple[int, ...], start: int) -> Iterator[tuple[int, ...]]:
            yield chosen
            for k in range(start, len(ready)):
                if all(self._share((i, 0), (ready[k], 0)) for i in chosen):
                    yield from extend((*chosen, ready[k]), k + 1)

        for chosen in extend((), 0):
            onward = self._outcome(moment, epoch, (*forced, *((i, 0) for i in chosen)))
            if onward is not None:
                yield chosen, onward

    def alone(self, moment: Moment, epoch: int, begun: int | None = None) -> Moment | None:
        """The moment after an epoch in which only one action begins, or none; None where that can't be."""
        return self.after(moment, epoch, () if begun is None else (begun,))

    def after(self, moment: Moment, epoch: int, begun: Iterable[int]) -> Moment | None:
        """The moment after an epoch in which some actions begin; None where that can't be."""
        going = self._forced(moment, epoch)
        if going is None:
            return None
        for action in begun:
            if not self._begins(action, moment, going):
                return None
            going = (*going, (action, 0))
        return self._outcome(moment, epoch, going)

    def supposed(self, moment: Moment, epoch: int, begun: Iterable[int]) -> Moment:
        """The same as somebody takes it to be who may be wrong: all goes on, whatever it asks."""
        going = (*moment.going, *((i, 0) for i in begun))
        for deed in self.task.script.begun(epoch):
            numbers = [self._numbers[id(action)] for action in deed.variants]
            possible = (i for i in numbers if usable(self._parts[i][0], moment.state))
            going = (*going, (next(possible, numbers[0]), 0))
        onward = self._outcome(moment, epoch, going)
        assert onward is not None, "nobody who may be wrong notices help"
        return onward

    def seen(self, believed: Going, true: Going, agents: Collection[int]) -> Going:
        """What somebody takes to be under way who sees what some agents are at, and with whom."""
        shown = {agent for i, _ in true if not self._who[i].isdisjoint(agents) for agent in self._who[i]}
        shown.update(agents)
        kept = [one for one in believed if self._who[one[0]].isdisjoint(shown)]
        return tuple(sorted((*kept, *(one for one in true if not self._who[one[0]].isdisjoint(shown)))))

    def idled(self, moment: Moment, epoch: int, last: int) -> Moment | None:
        """The moment after epoch ``last``, everybody idle until then; None where a bystander is disturbed."""
        now: Moment | None = moment
        while now is not None and epoch < last and (now.going or epoch < self.settled):
            epoch += 1
            now = self.alone(now, epoch)
        return now

    def reached(self, moment: Moment) -> bool:
        """Whether the human has what they want, and notices."""
        notices = self._notices
        unknown = notices is not None and notices.in_goal(moment.noticing)
        return holds(self.task.goal, moment.state) and not unknown

    def number(self, action: GroundAction) -> int:
        """The number of an action of a bystander."""
        return self._numbers[id(action)]

    def parts(self, action: int) -> tuple[GroundAction, ...]:
        """What an action asks and does, epoch by epoch."""
        return self._parts[action]

    def busy(self, moment: Moment, agent: int) -> bool:
        """Whether an agent is at something."""
        return any(agent in self._who[i] for i, _ in moment.going)

    def at_work(self, moment: Moment, epoch: int) -> bool:
        """Whether the human goes on with something in an epoch: what has begun before it all is a deed."""
        deeds = self.task.script.begun(epoch) if epoch <= self.settled else ()
        begun = any(self.task.human in deed.variants[0].participants for deed in deeds)
        return begun or self.busy(moment, self.task.human)

    def others_busy(self, moment: Moment) -> bool:
        """Whether a robot is at something."""
        return any(self.busy(moment, robot) for robot in self.task.robots)

    def plan_is_over(self, moment: Moment) -> bool:
        """Whether nobody but bystanders is at anything."""
        people = self.task.script.people
        return all(not people.isdisjoint(self._who[i]) for i, _ in moment.going)

    def _forced(self, moment: Moment, epoch: int) -> Going | None:
        """What goes on or is begun by bystanders in an epoch; None where something of it can't be."""
        begun = []
        for deed in self.task.script.begun(epoch):
            numbers = [self._numbers[id(action)] for action in deed.variants]
            possible = [i for i in numbers if usable(self._parts[i][0], moment.state)]
            if not possible:
                return None
            begun.append((possible[0], 0))
        forced = (*moment.going, *begun)
        if not all(usable(self._parts[i][k], moment.state) for i, k in forced):
            return None
        return forced if all(self._share(a, b) for a, b in combinations(forced, 2)) else None

    def _begins(self, action: int, moment: Moment, going: Going) -> bool:
        """Whether an action can begin beside what goes on."""
        ready = usable(self._parts[action][0], moment.state)
        return ready and all(self._share(other, (action, 0)) for other in going)

    def _may_share(self, a: tuple[int, int], b: tuple[int, int]) -> bool:
        """Whether two parts may share an epoch."""
        one, other = (self._parts[i][k] for i, k in (a, b))
        return compatible(one, other, strict=self._strict)

    def _outcome(self, moment: Moment, epoch: int, happening: Going) -> Moment | None:
        state = after(moment.state, [self._parts[i][k] for i, k in happening])
        if epoch <= self.settled:
            facts = [one for one in self.task.script.facts if one.epoch == epoch]
            state = (state - {one.fact for one in facts}) | {one.fact for one in facts if one.true}
        going = tuple(sorted((i, k + 1) for i, k in happening if k + 1 < len(self._parts[i])))
        noticing: Noticing | None = moment.noticing
        if self._notices is not None:
            begun = len(self.task.actions)
            parts = [Happening(self._parts[i][k], not k and i < begun, i >= begun) for i, k in happening]
            noticing = self._notices.after(moment.state, moment.noticing, parts, state)
        return None if noticing is None else Moment(state, going, moment.retired, noticing)


def action_sets(
    task: Task, state: State, candidates: Iterable[int], *, strict: bool = False
) -> Iterator[tuple[int, ...]]:
    """Every set of actions of one epoch each that is applicable in a state, the empty one included."""
    return (chosen for chosen, _ in OracleWorld(task, strict=strict).sets(Moment(state), 1, candidates))
