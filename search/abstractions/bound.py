"""The bound on what the human pays alone, for tasks in which the projection onto private fields says little.

Nobody else acts while the human is alone, so every field may be in a pattern.  The tables cost a fraction of
a second, so whoever asks has searched for a while in vain.
"""

from collections.abc import Callable, Sequence
from random import Random
from typing import Final

import numpy as np

from search.abstractions.cost_partitioning import CostPartitioning
from search.abstractions.patterns import Field, patterns
from search.abstractions.projection import Projection
from search.packed.cost_vector import FAR
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal, PackedTask
from search.packed.successor_generator import Lookup
from serendipity.model.resources.deadline import Deadline

_MOST_STATES: Final = 10_000
"""Of a projection."""

_MOST_TRANSITIONS: Final = 1_000_000
"""Of all projections together."""

_MOST_ORDERS: Final = 5
_SAMPLES: Final = 50
_LONGEST_WALK: Final = 30


def own_bound(
    packed: PackedTask,
    goal: PackedGoal,
    weight: Callable[[Operator], int],
    lookup: Lookup,
    start: int,
    deadline: Deadline,
) -> CostPartitioning | None:
    """A consistent lower bound from any packed state; None where tables can't hold the sums.

    Args:
        packed: the packed task.
        goal: what has to hold at the end.
        weight: of one of the human's own operators.
        lookup: the same operators by what they ask for.
        start: the packed state from which samples are drawn.
        deadline: polled while tables are made.
    """
    operators = list(packed.own)
    weights = [weight(op) for op in operators]
    if max(weights, default=0) * _MOST_STATES >= FAR:
        return None
    fields = [Field(f, (f & -f).bit_length() - 1, len(packed.values(f))) for f in packed.fields]
    projections: list[Projection] = []
    transitions = 0
    for pattern in patterns(fields, operators, goal, _MOST_STATES, deadline):
        projections.append(Projection(pattern, operators, goal, deadline))
        transitions += projections[-1].n_transitions
        if transitions > _MOST_TRANSITIONS:
            break
    if not projections:
        return None
    samples = _walks(start, lookup)
    return CostPartitioning(projections, np.array(weights, dtype=np.int64), samples, _MOST_ORDERS, deadline)


def _walks(start: int, lookup: Lookup) -> Sequence[int]:
    """The start, and where random walks from it end; always the same."""
    dice = Random(0)
    found = [start]
    while len(found) < _SAMPLES:
        state = start
        for _ in range(dice.randint(1, _LONGEST_WALK)):
            options = lookup.options(state)
            if not options:
                break
            option = dice.choice(options)
            state = state & option.keep | option.put
        found.append(state)
    return found
