"""Figures of the paper: Table I and Table II of Chakraborti et al., IROS 2015."""

from fractions import Fraction
from typing import Final, NamedTuple

TESTS: Final = frozenset(str(number) for number in range(1, 201))
"""The paper's 200 problems, by number."""


class Printed(NamedTuple):
    """One entry of Table I: the mean cost, and the number of problems in brackets."""

    mean: Fraction
    improved: int


def _column(text: str) -> dict[Fraction, Printed]:
    table = {}
    for entry in text.split(";"):
        discount, mean, improved = entry.split()
        table[Fraction(discount)] = Printed(Fraction(mean), int(improved))
    return table


TABLE_1: Final = {
    "serendipity": _column("0 9.82 1; 0.1 9.81 7; 0.3 9.79 7; 0.5 9.76 12; 0.7 9.68 29; 0.9 9.55 32"),
    "communication": _column("0 9.72 13; 0.1 9.65 23; 0.3 9.48 34; 0.5 9.25 40; 0.7 8.93 62; 0.9 8.51 70"),
}
"""By mode and discount; the second column stands for composite planning too."""

TABLE_2: Final = {"serendipity": 28.68, "communication": 33.93, "composite": 44.96}
"""Seconds by mode, on an Intel Xeon E5-1620 v2 with Gurobi, in 2015."""
