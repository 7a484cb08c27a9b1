"""What robots do for the human, counted: how many things of each kind they have seen to.

A field is counted where robots only ever set it, to one value, and never ask for it (an image is taken, data
have been sent).  Where things are alike, it does not matter to the human which of them it was.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from search.short_windows.independent.alike.things import Things
from search.short_windows.independent.provision import Value
from search.packed.operators import asked_by, split
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline


class Counter(NamedTuple):
    """Fields whose things can be exchanged for one another.

    Attributes:
        values: the fields, each with what robots set it to.
    """

    values: tuple[Value, ...]


class Tally(NamedTuple):
    """All that robots can leave behind for the human.

    Attributes:
        things: of the task.
        fields: all of it, with what has been done from the start.
        counters: how the rest is counted.
        counter_of: by field the number of its counter.
        kinds: by name the number of its kind; names of no kind are left out.
        names: the names of each kind.
    """

    things: Things
    fields: int
    counters: tuple[Counter, ...]
    counter_of: Mapping[int, int]
    kinds: Mapping[str, int]
    names: Sequence[Sequence[str]]


def tally(packed: PackedTask, relevant: int, deadline: Deadline) -> Tally | None:
    """How what robots can do for the human is counted; None where that can't be, or there is nothing alike.

    Args:
        packed: the packed task.
        relevant: the fields that matter to the human, or to a goal.
        deadline: polled.

    Raises:
        LimitReachedError: it came.
    """
    things = Things(packed, deadline)
    known = _counted(packed, relevant, things, deadline)
    if not known or _take_from_others(packed, known, deadline):
        return None
    counted = {field: value for field, value in known.items() if packed.init & field != value}
    if any(value not in things.mentioned for value in counted.items()):
        return None
    names = [
        kind
        for kind in things.alike()
        if all(sum(name in things.mentioned[value] for value in counted.items()) < 2 for name in kind)
    ]
    kinds = {name: number for number, kind in enumerate(names) for name in kind}
    members: dict[tuple[str | int, ...], list[Value]] = {}
    for value in counted.items():
        of_kinds = [name for name in things.mentioned[value] if name in kinds]
        if len(of_kinds) > 1:
            return None
        form = things.form(value, of_kinds[0], kinds[of_kinds[0]]) if of_kinds else (value[0],)
        members.setdefault(form, []).append(value)
    if all(len(values) == 1 for values in members.values()):
        return None
    counters = tuple(Counter(tuple(values)) for values in members.values())
    counter_of = {field: number for number, counter in enumerate(counters) for field, _ in counter.values}
    return Tally(things, sum(known), counters, counter_of, kinds, names)


def _counted(packed: PackedTask, relevant: int, things: Things, deadline: Deadline) -> dict[int, int]:
    """The fields that robots set for the human, and to what; nothing where one of them can't be counted."""
    fields = relevant & packed.changed_by(packed.others)
    found: dict[int, int] = {}
    for op in deadline.each((*packed.others, *packed.own)):
        is_robots = op.agents != packed.human_bit
        if is_robots and asked_by(op) & fields:
            return {}
        for field in split(fields & ~op.keep, things.fields):
            if found.setdefault(field, op.put & field) != op.put & field:
                return {}
    return found


def _take_from_others(packed: PackedTask, counted: Iterable[int], deadline: Deadline) -> bool:
    """Whether a robot asks for what the human or another robot may change."""
    changes: dict[int, int] = {}
    asks: dict[int, int] = {}
    counts = sum(counted)
    for op in deadline.each((*packed.others, *packed.own)):
        changes[op.agents] = changes.get(op.agents, 0) | packed.all_ones & ~op.keep & ~counts
        mentions = packed.mentioned(op) & ~counts
        asks[op.agents] = asks.get(op.agents, 0) | mentions
    return any(
        mentions & changed
        for agent, mentions in asks.items()
        if agent != packed.human_bit
        for other, changed in changes.items()
        if other != agent
    )
