"""Exact solution of ``n_i x_i = sum_j m_ij x_j + c_i`` for pairs, by elimination."""

from collections.abc import Sequence
from fractions import Fraction

from serendipity.model.resources.deadline import Deadline

Number = int | Fraction
Row = tuple[int, dict[int, int], tuple[Number, Number]]
"""``n_i``, the coefficients ``m_ij`` by ``j``, the pair ``c_i``."""


def solve_linear(rows: Sequence[Row], deadline: Deadline) -> list[tuple[Fraction, Fraction]] | None:
    """The pairs ``x_i``; None if the equations do not determine them.

    They do where every ``i`` leads out of the system in the end: its rows then sum to less
    than ``n_i`` somewhere on the way.
    """
    system: list[tuple[dict[int, Fraction], Fraction, Fraction]] = []
    for n, coefficients, (first, second) in rows:
        scaled = {j: Fraction(m, n) for j, m in coefficients.items()}
        system.append((scaled, Fraction(first) / n, Fraction(second) / n))
    for i in range(len(system)):
        own = 1 - system[i][0].pop(i, Fraction(0))
        if own == 0:
            return None
        row, first, second = system[i]
        system[i] = ({j: m / own for j, m in row.items()}, first / own, second / own)
        for k in range(len(system)):
            factor = system[k][0].pop(i, None) if k != i else None
            if factor is not None:
                deadline.tick()
                system[k] = _substitute(system[k], system[i], factor)
    return [(first, second) for _, first, second in system]


def _substitute(
    row: tuple[dict[int, Fraction], Fraction, Fraction],
    solved: tuple[dict[int, Fraction], Fraction, Fraction],
    factor: Fraction,
) -> tuple[dict[int, Fraction], Fraction, Fraction]:
    coefficients = row[0]
    for j, m in solved[0].items():
        coefficients[j] = coefficients.get(j, Fraction(0)) + factor * m
    return coefficients, row[1] + factor * solved[1], row[2] + factor * solved[2]
