"""Exactly-one groups by the form of the facts' names: ``on b *``, ``ontable b`` and ``holding * b``.

Facts are named ``predicate argument ...`` where a task comes from PDDL.  A *candidate* is a set
of slots (a predicate and one of its positions); its *instance* for an object has the facts
with that object there.  Candidates are found as in the invariant synthesis of Helmert (2009):
from single parts, by adding what an action that unbalances an instance takes or gives for it.
That is decided on one action of each form and only suggests groups: each is then
examined on all ground actions, so names can't make it wrong.
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.exactly_one import Balance
from serendipity.model.task.grown_groups import Group

_MAX_CANDIDATES: Final = 300


class Slot(NamedTuple):
    """Facts of a predicate (name, number of arguments), told apart by what stands at a position."""

    predicate: tuple[str, int]
    position: int


Candidate = frozenset[Slot]
"""Parts of different predicates."""

_Facts = Mapping[int, frozenset[Slot]]
"""Facts that mention an object, each with the parts by which it does."""


@dataclass(frozen=True, slots=True)
class _CountChange:
    """The changes of an action to the facts that mention an object."""

    needs: _Facts
    adds: _Facts
    deletes: _Facts

    def unbalances(self, candidate: Candidate) -> bool:
        """Whether it may leave another number than one of the instance's facts true."""
        needed, added, deleted = self._of(candidate)
        if len(needed) > 1:
            return False  # is never applicable
        if added:
            return len(added) > 1 or (needed != added and not (needed and needed <= deleted))
        return bool(deleted) and (not needed or needed <= deleted)

    def repairs(self, candidate: Candidate) -> frozenset[Slot]:
        """Parts of other predicates each of which may balance it; none where nothing can."""
        needed, added, _ = self._of(candidate)
        if len(added) == 1 and not needed:
            offers = [parts for fact, parts in self.needs.items() if fact in self.deletes]
        elif needed and not added:
            offers = [parts for fact, parts in self.adds.items() if fact not in self.needs]
        else:
            return frozenset()
        taken = {part.predicate for part in candidate}
        return frozenset(part for part in frozenset().union(*offers) if part.predicate not in taken)

    def _of(self, candidate: Candidate) -> Iterator[set[int]]:
        for facts in (self.needs, self.adds, self.deletes):
            yield {fact for fact, parts in facts.items() if not candidate.isdisjoint(parts)}


def groups_by_form(facts: Sequence[str], balance: Balance, deadline: Deadline) -> list[Group]:
    """Exactly-one groups that share no fact; none where names have no form."""
    atoms = [_atom(name) for name in deadline.each(facts)]
    changes = _by_part(_changes(_examples(deadline.each(balance.actions)), atoms))
    instances = {}
    for candidate in _balanced(changes, deadline):
        found = _instances(candidate, atoms)
        instances[candidate] = [group for group in found if len(balance.init.intersection(group)) == 1]
    return _covering(instances, lambda group: balance.exactly_one(set(group)), deadline)


_Atom = tuple[tuple[str, int], tuple[str, ...]]
"""A predicate and its arguments."""


def _atom(name: str) -> _Atom:
    predicate, *arguments = name.split() or [""]
    return (predicate, len(arguments)), tuple(arguments)


def _examples(actions: Iterable[GroundAction]) -> Iterable[GroundAction]:
    """One action of each form: schema, which arguments are equal, and how much it asks for and changes."""
    found: dict[tuple[object, ...], GroundAction] = {}
    for action in actions:
        key = action.key
        form = key[:1], tuple(map(key.index, key)), len(action.pre), len(action.add), len(action.delete)
        found.setdefault(form, action)
    return found.values()


def _changes(actions: Iterable[GroundAction], atoms: Sequence[_Atom]) -> Iterator[_CountChange]:
    """By action, and by object that its facts mention."""
    for action in actions:
        touched = {*action.pre, *action.add, *action.delete}
        for thing in sorted({argument for fact in touched for argument in atoms[fact][1]}):
            yield _CountChange(
                _mentioning(thing, action.pre, atoms),
                _mentioning(thing, action.add, atoms),
                _mentioning(thing, action.delete, atoms),
            )


def _mentioning(thing: str, facts: Iterable[int], atoms: Sequence[_Atom]) -> _Facts:
    found = {}
    for fact in facts:
        predicate, arguments = atoms[fact]
        parts = frozenset(Slot(predicate, i) for i, argument in enumerate(arguments) if argument == thing)
        if parts:
            found[fact] = parts
    return found


def _by_part(changes: Iterable[_CountChange]) -> dict[Slot, list[_CountChange]]:
    """The changes that add or delete facts of each part."""
    found: dict[Slot, list[_CountChange]] = {}
    for change in changes:
        parts = frozenset().union(*change.adds.values(), *change.deletes.values())
        for part in parts:
            found.setdefault(part, []).append(change)
    return found


def _balanced(changes: Mapping[Slot, Sequence[_CountChange]], deadline: Deadline) -> Iterator[Candidate]:
    """Candidates that no example unbalances, smaller ones first."""
    pending = deque(frozenset((part,)) for part in sorted(changes))
    seen = set(pending)
    while pending:
        deadline.check()
        candidate = pending.popleft()
        all_changes = (change for part in sorted(candidate) for change in changes.get(part, ()))
        change = next((change for change in all_changes if change.unbalances(candidate)), None)
        if change is None:
            yield candidate
        elif len(seen) < _MAX_CANDIDATES:
            more = [candidate | {part} for part in sorted(change.repairs(candidate))]
            pending.extend(larger for larger in more if larger not in seen)
            seen.update(more)


def _instances(candidate: Candidate, atoms: Sequence[_Atom]) -> list[Group]:
    """By object; those with two facts or more."""
    position = dict(candidate)
    found: dict[str, list[int]] = {}
    for fact, (predicate, arguments) in enumerate(atoms):
        if predicate in position:
            found.setdefault(arguments[position[predicate]], []).append(fact)
    return [tuple(group) for group in found.values() if len(group) > 1]


def _covering(
    instances: Mapping[Candidate, Sequence[Group]], exactly_one: Callable[[Group], bool], deadline: Deadline
) -> list[Group]:
    """Groups of one candidate after the other, always of the one whose groups have most facts left."""
    left = {candidate: list(groups) for candidate, groups in instances.items()}
    covered: set[int] = set()
    chosen: list[Group] = []
    known: dict[Group, bool] = {}
    while left:
        for candidate, groups in left.items():
            left[candidate] = [g for g in groups if covered.isdisjoint(g) and known.get(g, True)]
        best = max(left, key=lambda candidate: _worth(left[candidate]))
        unknown = [group for group in left[best] if group not in known]
        known.update({group: exactly_one(group) for group in deadline.each(unknown)})
        if all(known[group] for group in left[best]):
            chosen += left[best]
            covered.update(*left.pop(best))
    return chosen


def _worth(groups: Sequence[Group]) -> tuple[int, int]:
    """Facts that they cover, then how few they are."""
    return sum(map(len, groups)), -len(groups)
