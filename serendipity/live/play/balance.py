"""Who gets which condition, and the scenarios in which order: balanced, and drawn by a seed."""

from collections.abc import Sequence
from random import Random


def condition(participant: int, conditions: Sequence[str], seed: int) -> str:
    """The condition of a participant: each once in every block of participants, in a drawn order.

    Args:
        participant: from 0.
        conditions: to be shared out.
        seed: of the draws.
    """
    block, place = divmod(participant, len(conditions))
    shuffled = list(conditions)
    Random(f"{seed} block {block}").shuffle(shuffled)
    return shuffled[place]


def order(row: int, count: int) -> tuple[int, ...]:
    """A row of a Williams design: over all rows each scenario comes equally often in each place, and
    equally often right behind each other one.

    Args:
        row: from 0; rows begin again behind the last one.
        count: of scenarios; there are as many rows, or twice as many where that is odd.
    """
    zigzag = [0]
    for step in range(1, count):
        zigzag.append((step + 1) // 2 if step % 2 else count - step // 2)
    turned, mirrored = row % count, count % 2 and row // count % 2
    found = tuple((place + turned) % count for place in zigzag)
    return found[::-1] if mirrored else found
