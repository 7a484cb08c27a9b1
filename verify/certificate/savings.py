"""Savings of a result, by the cost of doing nothing, of the human alone at best, and its own."""

from fractions import Fraction

from serendipity.model import Result
from serendipity.model.numbers import agrees
from verify.base import wording


def savings_fault(result: Result, baseline: Fraction, idle: Fraction, cost: Fraction) -> str | None:
    """Why ``saving_alone`` or ``saving`` is wrong; None where neither is.

    Args:
        baseline: what doing nothing costs.
        idle: what the human pays at best without robots, or ``baseline``.
    """
    alone, saving = baseline - idle, baseline - cost if result.opportunity else Fraction(0)
    is_open = result.saving_alone is None and result.status == "feasible"  # a limit came first
    if not is_open and not agrees(result.saving_alone, alone):
        return wording.FIGURE.format("saving_alone", float(alone), result.saving_alone)
    if not agrees(result.saving, saving):
        return wording.FIGURE.format("saving", float(saving), result.saving)
    return None
