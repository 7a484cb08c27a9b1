"""Effects of unified-planning as effects of the grounder.

An object fluent that gets a value loses every other one.  Where the condition says which value it
has, only that one is named; else all are, which is no less true.
"""

from collections.abc import Iterator

from unified_planning.model import Effect as UPEffect
from unified_planning.model import FNode

from serendipity.pddl.parsing.lifted import And, Effect, Formula, Key, Literal, Parameter
from serendipity.up.conditions import Bound, Reader


def effects_of(reader: Reader, effect: UPEffect, precondition: Formula) -> Iterator[Effect]:
    """What one effect does.

    Raises:
        InputError: it changes a number.
    """
    if not effect.is_assignment():
        raise reader.error(f"effect '{effect}': numbers that change are not supported")
    bound, parameters = reader.bind(list(effect.forall), {})
    conditions = () if effect.condition.is_true() else (reader.formula(effect.condition, bound),)
    fluent, target = reader.target(effect.fluent, bound)
    if parameters:
        reader.quantified = True
    if fluent.type.is_bool_type():
        yield from _assigned(reader, effect.value, bound, target, parameters, conditions)
        return
    value = reader.term(effect.value, bound)
    known = _known_value(target, (precondition, *conditions))
    old = reader.value_of(fluent)
    gone = Literal((*target, known or old.name), positive=False)
    new = Literal((*target, *value.words))
    if known is None or value.hidden:
        reader.quantified = True
    yield _effect(gone, parameters if known else (*parameters, old), conditions)
    yield _effect(new, (*parameters, *value.hidden), (*conditions, *value.guards))


def _assigned(
    reader: Reader,
    value: FNode,
    bound: Bound,
    target: Key,
    parameters: tuple[Parameter, ...],
    conditions: tuple[Formula, ...],
) -> Iterator[Effect]:
    """A truth value that is assigned."""
    if value.is_bool_constant():
        yield _effect(Literal(target, value.bool_constant_value()), parameters, conditions)
        return
    for truth in (True, False):
        case = reader.formula(value, bound, positive=truth)
        yield _effect(Literal(target, truth), parameters, (*conditions, case))


def _effect(literal: Literal, parameters: tuple[Parameter, ...], conditions: tuple[Formula, ...]) -> Effect:
    condition = None
    if conditions:
        condition = conditions[0] if len(conditions) == 1 else And(conditions)
    return Effect(literal, parameters, condition)


def _known_value(target: Key, conditions: tuple[Formula, ...]) -> str | None:
    """The value that some conditions say a fluent has."""
    for part in conditions:
        if isinstance(part, And):
            found = _known_value(target, part.parts)
            if found is not None:
                return found
        elif isinstance(part, Literal) and part.positive and part.key[:-1] == target:
            return part.key[-1]
    return None
