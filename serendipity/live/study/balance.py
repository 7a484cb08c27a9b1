"""Who gets which condition, and the scenarios in which order: balanced, and drawn by a seed."""

from collections.abc import Iterator, Sequence
from random import Random


def places(conditions: Sequence[str], rounds: int, seed: int) -> Iterator[tuple[str, int]]:
    """The places of a study, one after another: a condition, and a row of :func:`order`.

    In every block each condition has each row once.  Within it, conditions come in groups, drawn in their
    order and in their size, that hold each of them once or twice: so nobody can tell the next one from those
    before, and the numbers are never far apart.

    Args:
        conditions: to be shared out.
        rounds: of each participant.
        seed: of the draws.
    """
    block = 0
    while True:
        dice = Random(f"{seed} block {block}")
        count = rounds * (1 + rounds % 2)
        rows = {name: dice.sample(range(count), count) for name in conditions}
        while left := len(rows[conditions[0]]):
            group = [*conditions] * min(left, dice.choice((1, 2)))
            dice.shuffle(group)
            yield from ((name, rows[name].pop()) for name in group)
        block += 1


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
