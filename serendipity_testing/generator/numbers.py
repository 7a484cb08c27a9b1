"""Numbers that are hard to add up: long denominators, huge costs, both in one task, ties but for a trifle."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Final

from serendipity.model import Task
from verify.base.optimal_plans import OptimalPlans

DISCOUNTS: Final = ("2/3", "1/7", "0.666666666667", "0.6666666666666666", "0.999999937", "0.000000000000001")
WEIGHTS: Final = ("1000000000", "999999999.999999999", "1000.000000000001", "1/7", "0.3333333333333333", "0")
"""Prices of an epoch of the window, or of communication."""

_DIGITS: Final = (6, 9, 12, 15)
_LONGEST: Final = 6
"""Actions of the human's plan: with other costs they may prefer ways that brute force gets lost on."""


def _trifle(dice: Random, cost: Fraction) -> Fraction:
    return cost + Fraction(dice.randint(1, 9), 10 ** dice.choice(_DIGITS))


def _ratio(dice: Random, cost: Fraction) -> Fraction:
    return cost * Fraction(*dice.choice(((1, 3), (2, 7), (53, 130), (9984, 9973), (549755813889, 10**12))))


def _huge(dice: Random, cost: Fraction) -> Fraction:
    return cost * 10 ** dice.choice(_DIGITS) + dice.choice((0, 0, 1))


_WAYS: Final[tuple[Callable[[Random, Fraction], Fraction], ...]] = (_trifle, _trifle, _ratio, _huge)


def oddly_priced(dice: Random, task: Task) -> Task:
    """The same task at other costs: up to ``10^15``, with denominators of up to ``10^15`` and of all kinds.

    Some actions, or all; in one way, or each in its own.  It stays as it is where the human would then
    need many steps.
    """
    ways = dice.choice(((dice.choice(_WAYS),), _WAYS))
    share = dice.choice((0.3, 1))
    costs = {
        name: dice.choice(ways)(dice, task.actions[ids[0]].cost)
        for name, ids in task.named.items()
        if dice.random() < share
    }
    actions = tuple(replace(action, cost=costs.get(action.name, action.cost)) for action in task.actions)
    priced = replace(task, actions=actions, known_variables=task.variables)
    worth = OptimalPlans(priced).alone.optimum(priced.init)
    return task if worth is not None and worth[1] > _LONGEST else priced


def odd_options(dice: Random, options: dict[str, str]) -> dict[str, str]:
    """The same options with other numbers, where there are any."""
    changed = {"discount": dice.choice(DISCOUNTS), "window_weight": dice.choice(WEIGHTS)}
    if options.get("communication_weight", "0") != "0":
        changed["communication_weight"] = dice.choice(WEIGHTS)
    if options.get("max_cost", "human") != "human":
        changed["max_cost"] = str(_trifle(dice, Fraction(options["max_cost"])))
    return options | {name: value for name, value in changed.items() if dice.random() < 0.6}
