"""Linear expressions over the columns of a program."""

from typing import NamedTuple

from verify.solvers.mip import Terms

Sum = dict[int, int]
"""Coefficients by column."""


class Linear(NamedTuple):
    """A linear expression: columns with their coefficients, and a constant."""

    terms: Terms
    constant: int = 0

    @property
    def is_zero(self) -> bool:
        """Whether it is 0 whatever the columns are."""
        return not self.terms and not self.constant


def plus(sums: Terms, more: Terms, factor: int = 1) -> Sum:
    """A sum of columns, and ``factor`` times another."""
    terms = dict(sums)
    for x, c in more.items():
        terms[x] = terms.get(x, 0) + factor * c
    return terms
