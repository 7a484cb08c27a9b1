"""Epochs of time: how long one is, and how many of them durations and timed literals come to."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from math import ceil, gcd
from typing import Final, cast

from serendipity.model import Condition, GroundAction, Timing, UsageError
from serendipity.model.numbers import Number, exact, plain
from serendipity.model.options import MAX_EPOCH
from serendipity.pddl.grounding.blocks import Block, Grounded
from serendipity.pddl.grounding.costs import BadCost, Cost
from serendipity.pddl.parsing.lifted import Key, Schema, TimedLiteral, Unit
from serendipity.pddl.parsing.tree import quoted

ONE: Final = Fraction(1)


def epoch_length(epoch: Number | None) -> Fraction | None:
    """The length of an epoch as callers give it; a UsageError where it is no number above 0."""
    length = None if epoch is None else exact(epoch, "epoch")
    if length is not None and length <= 0:
        raise UsageError(f"epoch: expected a number above 0, got {float(length):g}")
    return length


class Clock:
    """The length of an epoch, in the unit of the input, and what it makes of durations.

    Args:
        epoch: how long one is; None for the greatest common divisor of all durations and times of the
            script, where an action that is not durative has one unit of time.

    Attributes:
        rounded: the durations that are no whole epochs, each with the action that has it.
        rounded_times: whether that goes for a time of the script, too.
    """

    def __init__(self, units: Iterable[Unit], blocks: Sequence[Block], epoch: Fraction | None) -> None:
        self._units = [*units]
        self.rounded: dict[Fraction, Key] = {}
        self.rounded_times = False
        self._said: dict[tuple[int, Key], bool] = {}
        self.epoch = _common(self._units, blocks) if epoch is None else epoch

    def epochs(self, key: Key, duration: Cost) -> int:
        """The epochs that an action takes; an InputError for too many, and for what should be no duration."""
        if isinstance(duration, BadCost):
            raise duration.error(key)
        number = ceil(duration / self.epoch)
        if number > MAX_EPOCH:
            unit, schema = self._place(key)
            raise unit.domain_error(f"action {quoted(' '.join(key))}: {self._too_long(number)}", schema.line)
        if number * self.epoch != duration:
            self.rounded.setdefault(duration, key)
        return number

    def epoch_of(self, literal: TimedLiteral, unit: Unit) -> int:
        """The epoch with which a literal of the script becomes true."""
        number = ceil(literal.time / self.epoch)
        if number > MAX_EPOCH:
            raise unit.problem_error(f"timed literal: {self._too_long(number)}", literal.line)
        key, true = literal.literal
        if self._said.setdefault((number, key), true) != true:
            twice = f"{quoted(' '.join(key))} becomes true and false with epoch {number}"
            raise unit.problem_error(f"{twice} of {plain(self.epoch)}", literal.line)
        self.rounded_times |= number * self.epoch != literal.time
        return number

    def warnings(self) -> list[str]:
        """A line where durations were rounded, and one where times were."""
        whole = f"are rounded up to whole epochs of {plain(self.epoch)}"
        found = [f"times of the script {whole}"] if self.rounded_times else []
        for duration, key in [*self.rounded.items()][:1]:
            became = plain(ceil(duration / self.epoch) * self.epoch)
            example = f"{quoted(' '.join(key))} takes {became} instead of {plain(duration)}"
            found.append(f"durations {whole}: {example}")
        return found

    def _too_long(self, number: int) -> str:
        return (
            f"takes {number:,} epochs of {plain(self.epoch)}, expected at most {MAX_EPOCH:,}: "
            "longer epochs can be asked for with --epoch"
        )

    def _place(self, key: Key) -> tuple[Unit, Schema]:
        schemas = ((unit, schema) for unit in self._units for schema in unit.domain.schemas)
        return next((unit, schema) for unit, schema in schemas if schema.name == key[0] and schema.course)


def _common(units: Iterable[Unit], blocks: Iterable[Block]) -> Fraction:
    """The greatest common divisor of durations and times."""
    times = {literal.time for unit in units for literal in unit.problem.timed}
    for block in blocks:
        if block.durations is None:
            times |= {ONE} if len(block) else set()
        else:
            times |= {time for time in block.durations if isinstance(time, Fraction)}
    return reduce(_divisor, times) if times else ONE


def _divisor(a: Fraction, b: Fraction) -> Fraction:
    return Fraction(
        gcd(a.numerator * b.denominator, b.numerator * a.denominator), a.denominator * b.denominator
    )


def timed_action(record: Grounded, epochs: Callable[[Key, Cost], int]) -> GroundAction | None:
    """The ground action of a durative one; None where it is too short to be possible.

    Within a single epoch everything is asked before it, but for what its own start brings about.
    """
    key, who, ids, cost, duration = record
    assert duration is not None, "it is durative"
    pre, neg, add, delete, over, over_neg, end, end_neg, start_add, start_delete = ids
    name, number = " ".join(key), epochs(key, duration)
    price = cast(Fraction, cost)
    if number > 1:
        timing = Timing(number, Condition(over, over_neg), Condition(end, end_neg), start_add, start_delete)
        return GroundAction(name, who, pre, neg, add, delete, price, timing)
    needs = {*pre, *({*over, *end}.difference(start_add))}
    never = {*neg, *({*over_neg, *end_neg}.difference(start_delete))}
    if not needs.isdisjoint(never):
        return None
    true, false = {*add, *start_add}, {*delete, *start_delete}
    return GroundAction(
        name, who, _ids(needs), _ids(never), _ids(true), _ids(false.difference(true)), cost=price
    )


def _ids(facts: Iterable[int]) -> tuple[int, ...]:
    return tuple(sorted(facts))


def script_of(units: Iterable[Unit], facts: Mapping[Key, int]) -> tuple[frozenset[int], frozenset[int]]:
    """Ids of the facts that become true, and false, by timed literals, as far as an action knows them.

    Raises:
        InputError: a fact becomes true and false at the same time; with file and line.
    """
    said: dict[tuple[Fraction, Key], bool] = {}
    for unit in units:
        for timed in unit.problem.timed:
            key, true = timed.literal
            if said.setdefault((timed.time, key), true) != true:
                message = f"{quoted(' '.join(key))} becomes true and false at {plain(timed.time)}"
                raise unit.problem_error(message, timed.line)
    changed = [(facts[key], true) for (_, key), true in said.items() if key in facts]
    return (
        frozenset(fact for fact, true in changed if true),
        frozenset(fact for fact, true in changed if not true),
    )


def time_warnings(units: Sequence[Unit]) -> list[str]:
    """What is said once of how durations and metrics are read."""
    found = []
    for unit in units:
        if unit.problem.total_time:
            found.append(
                f"{unit.problem_file}: total-time is read as: actions cost their durations; what everybody "
                "spends is minimised, not the makespan"
            )
            break
    for unit in units:
        loose = [s for s in unit.domain.schemas if s.course is not None and not s.course.fixed]
        if loose:
            found.append(
                f"{unit.place(loose[0])}: of durations between bounds the least that is allowed is taken"
            )
            break
    return found
