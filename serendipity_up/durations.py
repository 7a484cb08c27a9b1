"""Durative actions and timed effects of unified-planning, in the grounder's words."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import chain
from typing import Final

from unified_planning.model import DurativeAction, TimeInterval, Timing
from unified_planning.model import Effect as UPEffect

from serendipity.pddl.parsing import lifted
from serendipity_up.conditions import Reader, effects_of
from serendipity_up.expressions import number_of

_START, _INSIDE, _END = range(3)

_EDGES: Final = "expected conditions and effects at start, over all or at end"


def durative_schema(
    reader: Reader, action: DurativeAction, name: str, increases: tuple[lifted.Expression, ...]
) -> lifted.Schema:
    """A durative action."""
    where = f"action '{action.name}'"
    if action.simulated_effects or action.continuous_effects:
        raise reader.error(f"{where}: simulated and continuous effects are not supported")
    conditions: tuple[list[lifted.Formula], ...] = ([], [], [])
    for interval, asked in action.conditions.items():
        for moment in _moments(reader, interval, where):
            conditions[moment].extend(map(reader.formula, asked))
    start, inside, end = (lifted.And(tuple(parts)) for parts in conditions)
    known = {_START: start, _END: lifted.And((inside, end))}
    effects: dict[int, list[lifted.Effect]] = {_START: [], _END: []}
    for timing, changes in action.effects.items():
        moment = _moment(reader, timing, where)
        for change in changes:
            effects[moment] += effects_of(reader, change, known[moment])
    if any(effect.condition is not None for some in effects.values() for effect in some):
        raise reader.error(f"{where}: conditional effects of durative actions are not supported")
    least, most = _duration(reader, action, where)
    return lifted.Schema(
        name,
        0,
        tuple(map(reader.parameter, action.parameters)),
        start,
        tuple(effects[_END]),
        increases,
        quantified=reader.quantified,
        course=lifted.DurativeParts((least,), (most,), inside, end, tuple(effects[_START])),
    )


def _duration(
    reader: Reader, action: DurativeAction, where: str
) -> tuple[lifted.Expression, lifted.Expression]:
    bounds = action.duration
    if bounds.is_left_open():
        raise reader.error(f"{where}: expected a least duration, got one that is longer than {bounds.lower}")
    return number_of(reader, bounds.lower, "a duration"), number_of(reader, bounds.upper, "a duration")


def _moments(reader: Reader, interval: TimeInterval, where: str) -> Iterator[int]:
    """The parts of a durative action that a condition is asked in."""
    first, last = (_moment(reader, timing, where) for timing in (interval.lower, interval.upper))
    if first == last:
        yield first
        return
    if first == _END:
        raise reader.error(f"{where}: {_EDGES}, got {interval}")
    if not interval.is_left_open():
        yield _START
    yield _INSIDE
    if not interval.is_right_open():
        yield _END


def _moment(reader: Reader, timing: Timing, where: str) -> int:
    if timing.delay or timing.is_global():
        raise reader.error(f"{where}: {_EDGES}, got {timing}")
    return _START if timing.is_from_start() else _END


def timed_literals(
    reader: Reader, timing: Timing, effects: Iterable[UPEffect]
) -> Iterator[lifted.TimedLiteral]:
    """The literals that become true at a time, whatever anybody does."""
    time = Fraction(timing.delay)
    if not timing.is_from_start() or time <= 0:
        raise reader.error(f"timed effect at {timing}: expected a time after the beginning")
    problem = reader.vocabulary.problem
    for effect in chain.from_iterable(one.expand_effect(problem) for one in effects):
        fixed = effect.value.is_bool_constant() or effect.value.is_object_exp()
        if effect.is_conditional() or not effect.is_assignment() or not fixed:
            raise reader.error(f"timed effect '{effect}': expected a fixed value and no condition")
        fluent, target = reader.target(effect.fluent, {})
        if fluent.type.is_bool_type():
            yield lifted.TimedLiteral(time, lifted.Literal(target, effect.value.is_true()), 0)
            continue
        chosen = reader.vocabulary.object(effect.value.object())
        for word in map(reader.vocabulary.object, problem.objects(fluent.type)):
            yield lifted.TimedLiteral(time, lifted.Literal((*target, word), word == chosen), 0)
