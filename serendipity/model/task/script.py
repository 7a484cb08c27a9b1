"""The script: what happens anyway (semantics 10.3), by names as callers write it and by ids."""

from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from typing import TYPE_CHECKING, Final

from serendipity.model.errors import UsageError
from serendipity.model.options import MAX_EPOCH
from serendipity.model.task.actions import NOOP, GroundAction
from serendipity.model.task.names import canonical_name, no_fact
from serendipity.model.task.plans import PlanEntry, checked_entries

if TYPE_CHECKING:
    from serendipity.model.task.task import Task


UNDER_WAY: Final = "~going"
"""Before the name of what somebody is in the middle of at first, who is no bystander, in single epochs."""


@dataclass(frozen=True, slots=True, order=True)
class TimedFact:
    """A fact that the script makes true or false with an epoch, last of all that happens in it."""

    epoch: int
    fact: int
    true: bool


@dataclass(frozen=True, slots=True)
class Deed:
    """An action that a bystander begins in an epoch: the first of its variants that is applicable then."""

    epoch: int
    agent: int
    variants: tuple[GroundAction, ...]

    @property
    def name(self) -> str:
        """The name of the action."""
        return self.variants[0].name

    @property
    def end(self) -> int:
        """The epoch with which it ends."""
        return self.epoch + self.variants[0].duration - 1


@dataclass(frozen=True)
class Timeline:
    """What happens anyway, by epoch; false where nothing does.

    Attributes:
        people: ids of the bystanders, of those who do nothing too.

    Raises:
        UsageError: an epoch is not in ``1 .. 1,000,000``, a fact is made true and false with one epoch, or a
            bystander begins something while something else of theirs goes on.
    """

    facts: tuple[TimedFact, ...] = ()
    deeds: tuple[Deed, ...] = ()
    people: frozenset[int] = frozenset()

    def __post_init__(self) -> None:
        for epoch in (*(one.epoch for one in self.facts), *(deed.epoch for deed in self.deeds)):
            if not 1 <= epoch <= MAX_EPOCH:
                raise UsageError(f"script: expected an epoch from 1 to {MAX_EPOCH}, got {epoch}")
        object.__setattr__(self, "facts", tuple(sorted(set(self.facts))))
        object.__setattr__(
            self, "deeds", tuple(sorted(self.deeds, key=lambda deed: (deed.epoch, deed.agent)))
        )
        busy: dict[int, Deed] = {}
        for deed in self.deeds:
            before = busy.get(deed.agent)
            if before is not None and before.end >= deed.epoch:
                raise UsageError(
                    f"script: '{deed.name}' begins in epoch {deed.epoch}, "
                    f"but '{before.name}' takes until the end of epoch {before.end}"
                )
            busy[deed.agent] = deed
        said: dict[tuple[int, int], bool] = {}
        for one in self.facts:
            if said.setdefault((one.epoch, one.fact), one.true) != one.true:
                raise UsageError(f"script: a fact becomes true and false with epoch {one.epoch}")

    def __bool__(self) -> bool:
        return bool(self.facts or self.deeds)

    @cached_property
    def last(self) -> int:
        """The last epoch with which it changes anything; after it nothing depends on the epoch."""
        return max([0, *(one.epoch for one in self.facts), *(deed.end for deed in self.deeds)])

    @cached_property
    def _eventful(self) -> list[int]:
        return sorted({*self._changes, *self._begun})

    def calm_until(self, epoch: int) -> int | None:
        """The last epoch before the script goes on after one; None where it does not."""
        place = bisect_right(self._eventful, epoch)
        return None if place == len(self._eventful) else self._eventful[place] - 1

    @cached_property
    def _changes(self) -> dict[int, tuple[frozenset[int], frozenset[int]]]:
        found: dict[int, tuple[set[int], set[int]]] = {}
        for one in self.facts:
            true, false = found.setdefault(one.epoch, (set(), set()))
            (true if one.true else false).add(one.fact)
        return {epoch: (frozenset(true), frozenset(false)) for epoch, (true, false) in found.items()}

    @cached_property
    def _begun(self) -> dict[int, tuple[Deed, ...]]:
        return {epoch: tuple(some) for epoch, some in groupby(self.deeds, key=lambda deed: deed.epoch)}

    def changes(self, epoch: int) -> tuple[frozenset[int], frozenset[int]]:
        """Ids of the facts that become true, and false, with an epoch."""
        return self._changes.get(epoch, (frozenset(), frozenset()))

    def begun(self, epoch: int) -> tuple[Deed, ...]:
        """What bystanders begin in an epoch."""
        return self._begun.get(epoch, ())

    def busy(self, agent: int) -> int:
        """Epochs at first in which somebody, who is no bystander, goes on with what they are at."""
        return max((deed.end for deed in self.deeds if agent in deed.variants[0].participants), default=0)

    def moments(self) -> Iterator[GroundAction]:
        """What it changes as actions of one epoch, for what asks only which facts may change how."""
        for epoch, (true, false) in sorted(self._changes.items()):
            yield GroundAction(f"script {epoch}", (0,), (), (), tuple(sorted(true)), tuple(sorted(false)))
        for deed in self.deeds:
            for action in deed.variants:
                yield from action.moments


@dataclass(frozen=True)
class Script:
    """What happens anyway, by names: what :meth:`.Task.with_script` adds to a task.

    ``Script(facts=[(8, "open c d"), (30, "!open shop")], people={"carol": [(2, "move carol c b")]})``: the
    door is open from the end of epoch 8 on, and Carol begins her walk in epoch 2.

    Attributes:
        facts: the epoch with which each changes (it holds, or with ``!`` in front no longer holds, in the
            state after it), and its name.
        people: the plan of each bystander, as a human's plan is given: actions one after another, or with
            the epochs in which they begin.

    Raises:
        UsageError: an entry has another form.
    """

    facts: Iterable[tuple[int, str]] = ()
    people: Mapping[str, Iterable[PlanEntry]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        listed = isinstance(self.facts, Iterable) and not isinstance(self.facts, str | Mapping)
        facts = tuple(self.facts) if listed else (self.facts,)
        for entry in facts:
            if not (isinstance(entry, tuple | list) and len(entry) == 2 and isinstance(entry[1], str)):
                raise UsageError(f"script: facts: expected pairs of an epoch and a fact, got {entry!r:.50}")
            if not isinstance(entry[0], int) or isinstance(entry[0], bool):
                raise UsageError(f"script: facts: expected a whole epoch, got {entry[0]!r:.50}")
        object.__setattr__(self, "facts", tuple((epoch, name) for epoch, name in facts))
        if not isinstance(self.people, Mapping):
            raise UsageError(f"script: people: expected plans by name, got {self.people!r:.50}")
        plans = {name: checked_entries(plan, f"script: {name}") for name, plan in self.people.items()}
        object.__setattr__(self, "people", plans)


def moments(actions: Sequence[GroundAction], script: Timeline) -> Sequence[GroundAction]:
    """All that may change facts in an epoch, as actions of one epoch (see :attr:`.GroundAction.moments`)."""
    if not script and all(action.timing is None for action in actions):
        return actions
    return [*(moment for action in actions for moment in action.moments), *script.moments()]


def resolved(task: "Task", script: Script) -> Timeline:
    """The script of a task with more in it.

    Raises:
        UsageError: there is no such fact or agent, a plan has an action that its person can't do alone, or
            something contradicts itself.
    """
    ids = {name: fact for fact, name in enumerate(task.facts)}
    facts = [*task.script.facts]
    for epoch, text in script.facts:
        name = canonical_name(text.strip().removeprefix("!"))
        if name not in ids:
            raise UsageError(f"script: {no_fact(name, ids)}")
        facts.append(TimedFact(epoch, ids[name], not text.strip().startswith("!")))
    deeds, people = [*task.script.deeds], {*task.script.people}
    for person, plan in script.people.items():
        agent = _bystander(task, canonical_name(person), people)
        people.add(agent)
        deeds += _deeds(task, agent, plan)
    return Timeline(tuple(facts), tuple(deeds), frozenset(people))


def _bystander(task: "Task", person: str, known: Collection[int]) -> int:
    if person not in task.agents:
        raise UsageError(f"script: expected one of {', '.join(task.agents)}, got '{person:.50}'")
    agent = task.agents.index(person)
    if agent == task.human:
        raise UsageError(f"script: '{person}' is the human, whose plan is no part of it")
    if agent in known:
        raise UsageError(f"script: '{person}' has a plan already")
    return agent


def _deeds(task: "Task", agent: int, plan: Iterable[PlanEntry]) -> Iterator[Deed]:
    following = 1
    for entry in plan:
        epoch, name = (following, entry) if isinstance(entry, str) else entry
        name = canonical_name(name)
        if name == NOOP or (name, agent) in task.waiting:
            continue
        ids = [i for i in task.named.get(name, ()) if task.actions[i].participants == (agent,)]
        if not ids:
            raise UsageError(f"script: '{name:.50}' is not an action that {task.agents[agent]} can do alone")
        deed = Deed(epoch, agent, tuple(task.actions[i] for i in ids))
        yield deed
        following = deed.end + 1
