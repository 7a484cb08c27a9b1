"""Which ground actions can ever be executed: delete-relaxed reachability over all agents."""

from collections.abc import Iterable, Sequence

from serendipity.pddl.instantiate import Record


def executable(records: Sequence[Record], init: Iterable[int], n_facts: int) -> list[Record]:
    """The records whose preconditions are reachable if nothing is ever deleted.

    A negative precondition on a fact that is true initially and that no executable
    action deletes is never met either.
    """
    init = frozenset(init)
    while True:
        kept = _reachable(records, init, n_facts)
        lasting = init.difference(*(record.delete for record in kept))
        possible = [r for r in kept if not r.neg or (lasting.isdisjoint(r.neg) and _consistent(r))]
        if len(possible) == len(kept):
            return kept
        records = possible


def _consistent(record: Record) -> bool:
    return not any(fact in record.pre for fact in record.neg)


def _reachable(records: Sequence[Record], init: frozenset[int], n_facts: int) -> list[Record]:
    """Each record waits for one fact at a time that is not reached yet."""
    reached = bytearray(n_facts)
    for fact in init:
        reached[fact] = 1
    waiting: list[list[Record]] = [[] for _ in range(n_facts)]
    kept: list[Record] = []
    pending: list[Record] = list(records)
    while pending:
        record = pending.pop()
        for fact in record.pre:
            if not reached[fact]:
                waiting[fact].append(record)
                break
        else:
            kept.append(record)
            for fact in record.add:
                if not reached[fact]:
                    reached[fact] = 1
                    pending += waiting[fact]
                    waiting[fact] = []
    return kept
