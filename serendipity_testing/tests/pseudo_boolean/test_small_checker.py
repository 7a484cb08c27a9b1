"""The small checker accepts nothing that an assignment denies, and reads OPB as it is meant."""

from itertools import product
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity_testing.pseudo_boolean.checker import ProofError, check
from serendipity_testing.pseudo_boolean.opb import Constraint, PseudoBooleanProblem, read

_NAMES = ("x1", "x2", "x3")


def _problem(dice: Random) -> PseudoBooleanProblem:
    problem = PseudoBooleanProblem(
        objective={x: dice.randint(-2, 3) for x in _NAMES} if dice.random() < 0.5 else None
    )
    for _ in range(dice.randint(1, 4)):
        terms = {x: dice.randint(-3, 3) for x in _NAMES if dice.random() < 0.8}
        problem.add(terms, dice.choice(("<=", ">=", "=")), dice.randint(-2, 3))
    return problem


def _step(dice: Random, known: int) -> str:
    if dice.random() < 0.5:
        one, other = dice.randint(1, known), dice.randint(1, known)
        return f"pol {one} {dice.randint(1, 3)} * {other} +"
    literals = (f"{dice.randint(1, 2)} {dice.choice(('', '~'))}{x}" for x in _NAMES if dice.random() < 0.6)
    return " ".join(("rup", *literals, ">=", f"{dice.randint(0, 2)} ;"))


@given(st.integers(0, 10**6))
def test_what_is_shown_is_so(seed: int) -> None:
    dice = Random(seed)
    problem = _problem(dice)
    solutions = [
        values
        for bits in product((0, 1), repeat=len(_NAMES))
        if all(each.holds(values := dict(zip(_NAMES, bits, strict=True))) for each in problem.constraints)
    ]
    lines, known = [f"f {len(problem.constraints)}"], len(problem.constraints)
    if problem.objective is not None and solutions:
        chosen = dice.choice(solutions)
        lines.append(" ".join(("o", *(f"{'' if chosen[x] else '~'}{x}" for x in _NAMES))))
        known += 1
    for _ in range(dice.randint(0, 3)):
        lines.append(_step(dice, known))
        known += 1
    try:
        shown = check(
            problem, "\n".join(("pseudo-Boolean proof version 1.1", *lines, "rup >= 1 ;", f"c {known + 1}"))
        )
    except ProofError:
        return
    least = min(map(problem.cost, solutions), default=None)
    assert shown == (None if problem.objective is None else least)
    assert problem.objective is not None or not solutions


def test_negated_literals_and_equalities_are_read() -> None:
    problem = read("* #variable= 2 #constraint= 2\nmin: +2 x1 -1 x2 ;\n3 ~x1 +1 x2 >= 2 ;\n+1 x1 = 1;\n")
    assert problem.objective == {"x1": 2, "x2": -1}
    assert problem.constraints == [
        Constraint({"x1": -3, "x2": 1}, -1),
        Constraint({"x1": 1}, 1),
        Constraint({"x1": -1}, -1),
    ]


@pytest.mark.parametrize("text", ["+1 x1 >= 1\n", "+1 x1 >= one ;\n", "x1 ;\n"])
def test_other_texts_are_no_problems(text: str) -> None:
    with pytest.raises(ValueError, match=r"expected|literal|unpack"):
        read(text)
