"""Executable ground actions, by delete-relaxed reachability over all agents."""

from collections import defaultdict
from collections.abc import Iterable, Sequence, Set
from itertools import accumulate, chain, compress
from operator import not_
from typing import Final

from serendipity.pddl.grounding.blocks import Block, Column, facts_of
from serendipity.pddl.work import Work

_SLICE: Final = 10_000
"""Actions between two looks at the deadline: a few milliseconds of them."""


def executable(
    blocks: Iterable[Block],
    init: Iterable[int],
    work: Work,
    script: tuple[Set[int], Set[int]] = (frozenset(), frozenset()),
) -> list[Block]:
    """The actions whose preconditions are reachable if nothing is ever deleted.

    What becomes true and false anyway, by ``script``, counts as added and deleted.

    A negative precondition on a fact that is true initially and that no executable
    action deletes is never met either.
    """
    init = frozenset(init)
    true, false = script
    while True:
        blocks = _reachable(blocks, init | true, work)
        lasting = {*init.difference(false)}
        for block in work.deadline.each(blocks, 1):
            lasting.difference_update(facts_of(block.deleted))
        possible = [_possible(block, lasting) for block in work.deadline.each(blocks, 1)]
        if sum(map(len, possible)) == sum(map(len, blocks)):
            return blocks
        blocks = possible


def _possible(block: Block, lasting: Set[int]) -> Block:
    for when in range(len(block.conditions)):
        positive, negative = block.conditions[when]
        if any(negative.table):
            block = block.only(_not_contradictory(negative, positive, lasting))
    return block


def _not_contradictory(negative: Column, positive: Column, lasting: Set[int]) -> list[bool]:
    """Where what must be false may be so, and need not be true as well."""
    pairs = zip(negative.rows(), positive.rows(), strict=True)
    return [lasting.isdisjoint(neg) and not any(fact in pre for fact in neg) for neg, pre in pairs]


def _reachable(blocks: Iterable[Block], init: frozenset[int], work: Work) -> list[Block]:
    ordered = sorted(blocks, key=len)  # what few actions reach lets many others settle at once
    search = _Reachability(ordered, init, work)
    stops = [*accumulate(map(len, ordered))]
    ranges = [range(stop - len(block), stop) for block, stop in zip(ordered, stops, strict=True)]
    for actions in ranges:
        search.settle(actions)
    return [
        block.only(search.executable[actions.start : actions.stop])
        for block, actions in zip(work.deadline.each(ordered, 1), ranges, strict=True)
    ]


class _Reachability:
    """The facts reached so far; an action waits for one fact at a time that is not."""

    def __init__(self, blocks: Sequence[Block], init: Iterable[int], work: Work) -> None:
        self.pre = [*chain.from_iterable(block.needs() for block in work.deadline.each(blocks, 1))]
        self.add = [*chain.from_iterable(block.gains() for block in work.deadline.each(blocks, 1))]
        self.reached = set(init)
        self.executable = bytearray(len(self.pre))
        self._waiting: defaultdict[int, list[int]] = defaultdict(list)
        self._check = work.deadline.check

    def settle(self, actions: Sequence[int]) -> None:
        """Execute some actions, as far as what they need is reached, and those that wait for them."""
        pending: list[Sequence[int]] = [actions]
        while pending:
            self._check()
            released = self._settle(pending.pop())
            pending += [released[i : i + _SLICE] for i in range(0, len(released), _SLICE)]

    def _settle(self, actions: Sequence[int]) -> list[int]:
        """Execute some actions, as far as what they need is reached; those that may be next."""
        met = [*map(self.reached.issuperset, map(self.pre.__getitem__, actions))]
        ready = [*compress(actions, met)]
        for action in ready:
            self.executable[action] = 1
        gained = {*chain.from_iterable(map(self.add.__getitem__, ready))} - self.reached
        self.reached |= gained
        released = [action for fact in gained for action in self._waiting.pop(fact, ())]
        for action in compress(actions, map(not_, met)):
            missing = next((fact for fact in self.pre[action] if fact not in self.reached), None)
            if missing is None:
                released.append(action)
            else:
                self._waiting[missing].append(action)
        return released
