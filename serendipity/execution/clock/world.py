"""The world as it truly is, in time: what has begun goes on, whatever anybody chooses (semantics 10.6)."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from serendipity.execution.world import Happened, Unfinished, World
from serendipity.model import PlanStep, Task
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.execution import participants
from serendipity.model.task.passing import doer, epoch_later
from serendipity.model.task.script import Deed, Timeline
from serendipity.robot import Outcome

_BYSTANDERS, _PERSON, _ROBOTS = range(3)
"""Who comes first where not everything is possible."""


_Key = tuple[str, int]
"""What goes on: the name of an action, and who leads in it."""


class WorldInTime(World):
    """A task's true state, and what goes on in it.

    Bystanders come first, then the person, then what robots are at, then what they begin.  What can't go on
    is broken off, and has no more effect; a bystander who can't do what they planned does nothing more.
    """

    def __init__(self, task: Task, discount: Fraction, *, strict: bool) -> None:
        super().__init__(task, discount, strict=strict)
        self._now = task
        self._ready: frozenset[_Key] = frozenset()
        """What robots say that they have done, and what goes on by the plan."""

    @property
    def now(self) -> Task:
        """See :class:`.World`."""
        return self._now

    @property
    def going(self) -> tuple[PlanStep, ...]:
        """What goes on in the epoch that is to come, with the epochs that are left; not of bystanders."""
        return tuple(self._step(deed) for deed in self._due() if self._rank(deed) != _BYSTANDERS)

    def applicable(self, action: int) -> bool:
        """Whether the person can begin an action now: nobody who comes first is in its way."""
        one = self.task.actions[action]
        if not one.applicable(self.state):
            return False
        first = [deed for deed in self._possible(self._due()) if self._rank(deed) != _ROBOTS]
        return self._fits(first, [one])

    def play(
        self,
        his: int | None,
        robots: Sequence[PlanStep],
        carry_out: Callable[[Sequence[PlanStep]], Sequence[Outcome]],
    ) -> Happened:
        """See :class:`.World`; robots are asked for what they are at, too, until they say that it is done."""
        due, hers = self._due(), [] if his is None else [his]
        kept = self._possible(due, hers)
        obstacles = self._obstacles(robots, kept, hers)
        asked = [deed for deed in kept if self._rank(deed) == _ROBOTS and _key(deed) not in self._ready]
        possible = [step for step, why in zip(robots, obstacles, strict=True) if why is None]
        keys = (*map(_key, asked), *(self._key_of(step) for step in possible))
        reports = dict(zip(keys, carry_out((*map(self._step, asked), *possible)), strict=True))
        ends = {deed: why for deed in due if (why := _ended(deed, kept, reports)) is not None}
        meant = [(s, why or self._unbegun(s, reports)) for s, why in zip(robots, obstacles, strict=True)]
        executed = (*hers, *(self.of(step) for step, why in meant if why is None))
        missed = [(self._step(deed), why) for deed, why in ends.items()]
        missed += [(step, why) for step, why in meant if why is not None]
        goes_on = [deed for deed in kept if deed not in ends]
        going = tuple(self._step(deed) for deed in goes_on if self._rank(deed) != _BYSTANDERS)
        self._move(goes_on, ends, executed)
        running = {key for key, outcome in reports.items() if outcome == "running"}
        self._ready = frozenset(map(_key, self._due())) - running
        return Happened(executed, tuple(Unfinished(*pair) for pair in missed), going)

    def change(self, facts: Iterable[tuple[str, bool]]) -> None:
        """See :class:`.World`."""
        super().change(facts)
        self._now = self._now.at(self.state)

    def drop(self, robots: Iterable[int]) -> None:
        """See :class:`.World`."""
        gone = frozenset(robots)
        self._hold([d for d in self._now.script.deeds if gone.isdisjoint(d.variants[0].participants)])

    def _move(self, kept: Sequence[Deed], ends: dict[Deed, str], executed: Sequence[int]) -> None:
        """Let an epoch go by."""
        still = {deed.agent for deed in ends if self._rank(deed) == _BYSTANDERS}
        later = [deed for deed in self._now.script.deeds if deed.epoch > 1 and deed.agent not in still]
        self._hold([*kept, *later])
        self._now = epoch_later(self._now, [self.task.actions[i] for i in executed], strict=self._strict)
        late = [deed for deed, why in ends.items() if why == "running"]
        if late:
            self._hold([*self._now.script.deeds, *late])
        self.state = self._now.init

    def _hold(self, deeds: Iterable[Deed]) -> None:
        """Let these be what goes on, and what bystanders do."""
        script = replace(self._now.script, deeds=tuple(deeds))
        self._now = replace(self._now, script=script, known_variables=self._now.variables)

    def _due(self) -> list[Deed]:
        """What goes on, and what bystanders begin, in the epoch that is to come: who comes first, first."""
        return sorted(self._now.script.begun(1), key=self._rank)

    def _rank(self, deed: Deed) -> int:
        agents = deed.variants[0].participants
        if not self.task.script.people.isdisjoint(agents):
            return _BYSTANDERS
        return _PERSON if self.task.human in agents else _ROBOTS

    def _possible(self, due: Sequence[Deed], begun: Sequence[int] = ()) -> list[Deed]:
        """Those that are possible beside the ones before, and what the person begins."""
        his = [self.task.actions[i] for i in begun]
        kept: list[Deed] = []
        for deed in due:
            if self._fits([*kept, deed], his if self._rank(deed) == _ROBOTS else ()):
                kept.append(deed)
        return kept

    def _fits(self, deeds: Sequence[Deed], begun: Iterable[GroundAction]) -> bool:
        """Whether an epoch with some deeds, and what is begun beside them, is possible."""
        script = Timeline(deeds=tuple(deeds), people=self.task.script.people)
        try:
            PlayedPlan(self.task.facts, self.state, script, strict=self._strict).begin(begun)
        except BrokenPlanError:
            return False
        return True

    def _obstacles(
        self, robots: Sequence[PlanStep], kept: Sequence[Deed], hers: Sequence[int]
    ) -> list[str | None]:
        """Why robots can't begin some steps, one after another; None where they can."""
        actions, begun, found = self.task.actions, [*hers], list[str | None]()
        for step in robots:
            action = self.of(step)
            if not actions[action].applicable(self.state):
                found.append("inapplicable")
            elif not self._fits(kept, [actions[i] for i in (*begun, action)]):
                found.append("conflict")
            else:
                begun.append(action)
                found.append(None)
        return found

    def _unbegun(self, step: PlanStep, reports: Mapping[_Key, Outcome]) -> str | None:
        """Why an action that robots were told to begin has not begun; None where it has."""
        longer, outcome = self.task.actions[self.of(step)].duration > 1, reports[self._key_of(step)]
        return None if outcome == "done" or (outcome == "running" and longer) else outcome

    def _key_of(self, step: PlanStep) -> _Key:
        """The key of what will be left of an action."""
        action = self.task.actions[self.of(step)]
        return action.name, doer(self.task, action)

    def _step(self, deed: Deed) -> PlanStep:
        action = deed.variants[0]
        return PlanStep(1, participants(self.task, action), action.name, 0.0, action.duration)


def _key(deed: Deed) -> _Key:
    return deed.name, deed.agent


def _ended(deed: Deed, kept: Sequence[Deed], reports: Mapping[_Key, Outcome]) -> str | None:
    """Why something that was due does not go on in this epoch; None where it does."""
    if deed not in kept:
        return "broken"
    outcome = reports.get(_key(deed), "done")
    is_last = deed.variants[0].duration == 1
    return outcome if outcome == "failed" or (outcome == "running" and is_last) else None
