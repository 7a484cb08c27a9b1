"""Which ground actions can ever be executed: delete-relaxed reachability over all agents."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from itertools import accumulate, chain, compress
from operator import not_

from serendipity.pddl.blocks import Block


def executable(blocks: Iterable[Block], init: Iterable[int]) -> list[Block]:
    """The actions whose preconditions are reachable if nothing is ever deleted.

    A negative precondition on a fact that is true initially and that no executable
    action deletes is never met either.
    """
    init = frozenset(init)
    while True:
        blocks = _reachable(blocks, init)
        lasting = init.difference(*(block.delete.facts() for block in blocks))
        possible = [_possible(block, lasting) for block in blocks]
        if sum(map(len, possible)) == sum(map(len, blocks)):
            return blocks
        blocks = possible


def _possible(block: Block, lasting: frozenset[int]) -> Block:
    if not any(block.neg.table):
        return block
    pairs = zip(block.neg.rows(), block.pre.rows(), strict=True)
    return block.only(
        [lasting.isdisjoint(neg) and not any(fact in pre for fact in neg) for neg, pre in pairs]
    )


def _reachable(blocks: Iterable[Block], init: frozenset[int]) -> list[Block]:
    ordered = sorted(blocks, key=len)  # what few actions reach lets many others settle at once
    search = _Reachability(ordered, init)
    stops = [*accumulate(map(len, ordered))]
    ranges = [range(stop - len(block), stop) for block, stop in zip(ordered, stops, strict=True)]
    for actions in ranges:
        search.settle(actions)
    return [
        block.only(search.executable[actions.start : actions.stop])
        for block, actions in zip(ordered, ranges, strict=True)
    ]


class _Reachability:
    """What is reached so far; an action waits for one fact at a time that is not."""

    def __init__(self, blocks: Sequence[Block], init: Iterable[int]) -> None:
        self.pre = [*chain.from_iterable(block.pre.rows() for block in blocks)]
        self.add = [*chain.from_iterable(block.add.rows() for block in blocks)]
        self.reached = set(init)
        self.executable = bytearray(len(self.pre))
        self._waiting: defaultdict[int, list[int]] = defaultdict(list)

    def settle(self, actions: Sequence[int]) -> None:
        """Execute some actions, as far as what they need is reached, and those that wait for them."""
        while actions:
            met = [*map(self.reached.issuperset, map(self.pre.__getitem__, actions))]
            ready = [*compress(actions, met)]
            for action in ready:
                self.executable[action] = 1
            gained = {*chain.from_iterable(map(self.add.__getitem__, ready))} - self.reached
            self.reached |= gained
            late = compress(actions, map(not_, met))
            actions = [action for fact in gained for action in self._waiting.pop(fact, ())]
            for action in late:
                missing = next((fact for fact in self.pre[action] if fact not in self.reached), None)
                if missing is None:
                    actions.append(action)
                else:
                    self._waiting[missing].append(action)
