"""Operators that a plan within a limit may have, as the landmarks of one state tell (reduced cost fixing).

Landmarks share out the weights of operators, so a plan weighs at least what they weigh together.  A plan
with a certain operator weighs at least as much as that operator and all landmarks that it is not of: what
landmarks weigh together, less the operator's share of them, plus its weight.  Where that is no less than the
limit, no plan within it has the operator.  Without such operators there are fewer ways, so landmarks weigh
more, and other operators may go; facts that none of those left changes are as they were at first.
"""

from collections.abc import Sequence

from serendipity.model import Deadline
from verify.packed.landmark_cuts import LandmarkCuts
from verify.packed.operators import PackedOperator


def affordable(
    operators: Sequence[PackedOperator],
    facts: frozenset[int],
    goal: Sequence[int],
    start: frozenset[int],
    below: int,
    deadline: Deadline,
) -> list[int] | None:
    """The numbers of the operators that are left; None: no plan weighs less than the limit.

    Args:
        operators: what may be done.
        facts: those that matter.
        goal: facts that have to be true in the end.
        start: facts that are true at first.
        below: plans of this weight or more don't count.
        deadline: polled.

    Raises:
        LimitReachedError: the deadline came first.
    """
    kept = list(range(len(operators)))
    while True:
        before = len(kept)
        for rarest in (True, False):
            deadline.check()
            cuts = LandmarkCuts([operators[i] for i in kept], facts, goal, rarest=rarest)(start)
            if cuts.bound >= below:
                return None
            shares = dict(zip(cuts.operators.tolist(), cuts.shares.tolist(), strict=True))
            kept = [
                i
                for number, i in enumerate(kept)
                if cuts.bound - shares.get(number, 0) + operators[i].weight < below
            ]
        kept = _reachable(operators, kept, facts, start, deadline)
        if len(kept) == before:
            return kept


def _reachable(
    operators: Sequence[PackedOperator],
    kept: list[int],
    facts: frozenset[int],
    start: frozenset[int],
    deadline: Deadline,
) -> list[int]:
    """Those that can be executed at all, if nothing is ever deleted."""
    true = set(start)
    found: set[int] = set()
    waiting = kept
    while True:
        ready = [i for i in deadline.each(waiting) if all(f in true for f in operators[i].pre if f in facts)]
        if not ready:
            return sorted(found)
        found.update(ready)
        true.update(fact for i in ready for fact in operators[i].add)
        done = set(ready)
        waiting = [i for i in waiting if i not in done]
