"""Rows that teach a program about a suffix that is not the human's optimal plan."""

from verify.base.control import INSIDE, SUFFIX
from verify.programs.automata.linear import plus
from verify.programs.automata.program import NetworkProgram


def bound_suffix(program: NetworkProgram, xi2: int, state: frozenset[int], least: int | None) -> None:
    """A suffix from ``state`` at ``xi2`` weighs at least ``least``; with None there is none.

    The condition is a sum of literals that is 0 exactly in that case and at most -1 else.

    Args:
        program: the program that learns the bound.
        xi2: first epoch of the suffix.
        state: facts that hold at its begin.
        least: units of the objective, or None.
    """
    literals, constant = _suffix_starts(program, xi2, state)
    for f in program.deadline.each(
        sorted(program.setting.part.facts - program.setting.human.automaton.facts)
    ):
        terms, fixed = program.facts.truth(f, xi2 - 1)
        sign = 1 if f in state else -1
        literals = plus(literals, terms, sign)
        constant += fixed - 1 if f in state else -fixed
    program.model.family = "Def. 2.0a"
    if least is None:
        program.model.add(literals, "<=", -1 - constant)
    else:
        scaled = {x: -least * c for x, c in literals.items()}
        program.model.add(plus(scaled, _suffix_weights(program)), ">=", least * (constant + 1))


def _suffix_starts(program: NetworkProgram, xi2: int, state: frozenset[int]) -> tuple[dict[int, int], int]:
    """Minus 1 unless the suffix starts at ``xi2`` with the human's private facts as in ``state``."""
    network = program.setting.human
    layer, columns = network.layers[xi2 - 1], program.flows.columns[program.task.human][xi2 - 1]
    starts: dict[int, int] = {}
    for (source, target, *_), x in zip(program.deadline.each(layer), columns, strict=True):
        begins = network.controls[source][0] == INSIDE and network.controls[target][0] == SUFFIX
        if begins and network.true_facts(source) == state & network.automaton.facts:
            starts[x] = 1
    return starts, -1


def _suffix_weights(program: NetworkProgram) -> dict[int, int]:
    weights: dict[int, int] = {}
    for layer, columns in zip(
        program.setting.human.layers, program.flows.columns[program.task.human], strict=True
    ):
        for (_, target, _, weight, _), x in zip(program.deadline.each(layer), columns, strict=True):
            if weight and program.setting.human.controls[target][0] == SUFFIX:
                weights[x] = weight
    return weights
