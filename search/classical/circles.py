"""Sets of actions that need one epoch: they disable each other in circles that hang together (semantics 2).

Where epochs don't count, every other set of actions can be done one after another.
"""

from collections.abc import Iterator, Sequence
from itertools import chain
from typing import Final

from search.packed.operators import Operator, forms_of, union
from search.packed.packed_task import PackedTask
from serendipity.model.resources.deadline import Deadline

_MOST: Final = 20_000
"""Steps of the search for circles."""

_MOST_PAIRS: Final = 5_000_000
"""Pairs that it may start from."""


_MOST_FORMS: Final = 2_000
"""Forms of operators that are compared with each other."""


class TooManyError(Exception):
    """There may be more circles than can be listed."""


def circles(
    packed: PackedTask, operators: Sequence[Operator], deadline: Deadline
) -> Iterator[tuple[Operator, ...]]:
    """Every circle of operators that some state may allow, and those with operators in common together.

    Raises:
        TooManyError: they are too many.
    """
    operators = _suspects(packed, operators, deadline)
    pairs: dict[int, list[int]] = {}
    for number, other in disabled(packed, operators, operators, deadline):
        pairs.setdefault(number, []).append(other)
    after_each = _in_turn(pairs, deadline)
    found: dict[frozenset[int], None] = {}
    steps = 0
    for first in sorted(after_each):
        ways: list[tuple[int, ...]] = [(first,)]
        while ways:
            deadline.tick()
            steps += 1
            if steps > _MOST:
                raise TooManyError
            way = ways.pop()
            for after in after_each.get(way[-1], ()):
                if after == first and len(way) > 1:
                    found[frozenset(way)] = None
                    yield tuple(operators[i] for i in way)
                elif (
                    after > first
                    and after not in way
                    and _fits(packed, [operators[i] for i in way], operators[after])
                ):
                    ways.append((*way, after))
    for joined in _joined(packed, operators, [*found], deadline):
        yield tuple(operators[i] for i in sorted(joined))


def _joined(
    packed: PackedTask, operators: Sequence[Operator], found: list[frozenset[int]], deadline: Deadline
) -> Iterator[frozenset[int]]:
    """Circles with operators in common: they need the same epoch, as none can be done before the others."""
    known, pending, pairs = {*found}, [*found], 0
    around: dict[int, list[frozenset[int]]] = {}
    for circle in found:
        for i in circle:
            around.setdefault(i, []).append(circle)
    everybody = union(operators[i].agents for i in around)
    while pending:
        some = pending.pop()
        members = [operators[i] for i in sorted(some)]
        if not everybody & ~union(op.agents for op in members):
            continue
        for circle in chain.from_iterable(around[i] for i in sorted(some)):
            deadline.tick()
            pairs += 1
            if pairs > _MOST_PAIRS or len(known) > _MOST:
                raise TooManyError
            if some | circle in known:
                continue
            if all(_fits(packed, members, operators[i]) for i in circle - some):
                known.add(some | circle)
                pending.append(some | circle)
                yield some | circle


def _suspects(packed: PackedTask, operators: Sequence[Operator], deadline: Deadline) -> list[Operator]:
    """The operators that may be in circles as far as their forms tell."""
    forms = forms_of(operators, packed.all_ones, deadline)
    if len(forms) > _MOST_FORMS:
        return list(operators)
    # Two that set one variable of many values undo each other, so they don't share an epoch.
    wide = sum(field for field in packed.fields if len(packed.values(field)) > 2)
    told = [(form.agents, form.sets, form.sets & wide, form.need_mask | form.forbids) for form in forms]
    disabled: dict[int, list[int]] = {}
    for number, (busy, sets, undoes, _) in enumerate(told):
        deadline.tick()
        others = [i for i, (a, _, w, asks) in enumerate(told) if sets & asks and not (a & busy or w & undoes)]
        if others:
            disabled[number] = others
    left = _in_turn(disabled, deadline)
    found = {id(op) for number in left for op in forms[number].ops}
    return [op for op in operators if id(op) in found]


def _in_turn(disabled: dict[int, list[int]], deadline: Deadline) -> dict[int, list[int]]:
    """Leaves out who disables nobody, as long as there is anybody: the others may be in circles."""
    by: dict[int, list[int]] = {}
    for number, others in deadline.each(disabled.items()):
        for other in others:
            by.setdefault(other, []).append(number)
    left = {number: len(others) for number, others in disabled.items()}
    idle = [number for number in by if number not in left]
    while idle:
        deadline.tick()
        for number in by.get(idle.pop(), ()):
            left[number] -= 1
            if not left[number]:
                del left[number]
                idle.append(number)
    return {number: [other for other in disabled[number] if other in left] for number in left}


Asking = dict[tuple[int, int], dict[int, list[int]]]
"""Operators that ask for a field's value, by field and value, and by their agents."""


def disabled(
    packed: PackedTask, operators: Sequence[Operator], others: Sequence[Operator], deadline: Deadline
) -> Iterator[tuple[int, int]]:
    """Numbers of operators with those of others, by other agents, that they may disable in the same epoch.

    Raises:
        TooManyError: there may be more pairs than are looked at.
    """
    needing, forbidding = _asking(packed, others, deadline)
    pairs = 0
    for number, op in enumerate(deadline.each(operators)):
        for field in packed.split(packed.all_ones & ~op.keep):
            put = op.put & field
            asked = [op.need & field] if op.need_mask & field else packed.values(field)
            groups = [needing.get((field, value), {}) for value in asked if value != put]
            groups.append(forbidding.get((field, put), {}))
            by_agents = chain.from_iterable(group.items() for group in groups)
            for other in chain.from_iterable(them for agents, them in by_agents if not agents & op.agents):
                deadline.tick()
                pairs += 1
                if pairs > _MOST_PAIRS:
                    raise TooManyError
                if _fits(packed, [op], others[other]):
                    yield number, other


def _asking(packed: PackedTask, operators: Sequence[Operator], deadline: Deadline) -> tuple[Asking, Asking]:
    """Operators by the values that they need, and by those that they forbid."""
    needing: Asking = {}
    forbidding: Asking = {}
    for number, op in enumerate(deadline.each(operators)):
        for field in packed.split(op.need_mask):
            # Two may both make true what both need to be false: adding a fact twice is no conflict.
            if op.keep & field or not op.need & field:
                by_agents = needing.setdefault((field, op.need & field), {})
                by_agents.setdefault(op.agents, []).append(number)
        for field, value in op.forbidden:
            forbidding.setdefault((field, value), {}).setdefault(op.agents, []).append(number)
    return needing, forbidding


def _fits(packed: PackedTask, others: Sequence[Operator], op: Operator) -> bool:
    """Whether an operator may share an epoch with others, as far as can be told without a state."""
    for other in others:
        both = op.need_mask & other.need_mask
        if op.agents & other.agents or op.need & both != other.need & both:
            return False
        if not packed.compatible(other.action, op.action, strict=False):
            return False
    return True
