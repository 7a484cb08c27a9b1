"""The exact value of a policy: along the ways to its ends, by elimination where runs may return."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from search.engine.and_or import AndOrGraph, Rule
from search.modes.assistance.game.game import Move
from search.modes.assistance.game.rules import ChoiceRule, Mean, Value
from serendipity.model.resources.deadline import Deadline


class Option(NamedTuple):
    """A supporter's move with what the prime may make of it."""

    move: Move
    end: Value | None
    """What follows the move, where the game goes no further; else None."""
    outcomes: tuple[Move, ...]
    """The prime's moves otherwise."""


Outside = Callable[[int], Value]
"""The value of a state in which no option is chosen."""


def option_value(option: Option, rule: ChoiceRule, value_of: Outside) -> Value:
    """An option's value by the values of its outcomes."""
    rest = option.end
    if rest is None:
        rest = rule.combine([rule.add(move.value, value_of(move.after)) for move in option.outcomes])
    return rule.add(option.move.value, rest)


def evaluate(
    policy: Mapping[int, Option], rule: ChoiceRule, outside: Outside, deadline: Deadline
) -> dict[int, Value]:
    """Values of all states of a policy, which has an option for each; infinite where a run may not end."""
    if isinstance(rule, Mean):
        return _mean(policy, rule, outside, deadline)
    found, _ = forced({state: [option] for state, option in policy.items()}, rule, outside, deadline)
    return {state: found.get(state, rule.infinite) for state in policy}


def forced(
    model: Mapping[int, Sequence[Option]], rule: ChoiceRule, outside: Outside, deadline: Deadline
) -> tuple[dict[int, Value], dict[int, Option]]:
    """Least values and options of all states from which the end can be forced; not for means."""
    options: list[Option] = []
    rules: list[Rule[int]] = []
    for state, listed in deadline.each(model.items()):
        for option in listed:
            options.append(option)
            rules.append(Rule({move.after for move in option.outcomes if move.after in model}, (state,)))

    def value(k: int, values: Mapping[int, int]) -> int:
        def value_of(state: int) -> Value:
            return values[state] if state in model else outside(state)

        return int(option_value(options[k], rule, value_of))

    found, chosen = AndOrGraph(rules, deadline).settle((), value, rule.infinite)
    return found, {state: options[chosen[state]] for state in found}


Number = int | Fraction


class _Row(NamedTuple):
    """A state's mean costs: multiples of those of other states, and the rest, of prime and supporter."""

    others: dict[int, Number]
    rest: tuple[Number, Number]

    def plus(self, factor: Number, row: "_Row") -> "_Row":
        """The sum with a multiple of another one."""
        others = dict(self.others)
        for state, m in row.others.items():
            others[state] = others.get(state, 0) + factor * m
        return _Row(others, (self.rest[0] + factor * row.rest[0], self.rest[1] + factor * row.rest[1]))


def _mean(policy: Mapping[int, Option], rule: Mean, outside: Outside, deadline: Deadline) -> dict[int, Value]:
    """Mean values, by Gaussian elimination: each state by those that come after it, then from the last one.

    A state whose run may not end, or not without an infinite value, is None among the rows.
    """
    order = {state: i for i, state in enumerate(_ends_first(policy))}
    rows: dict[int, _Row | None] = {}
    for state in order:
        row = _first_row(policy, state, rule, outside)
        while row is not None and row.others:
            deadline.tick()
            earlier = min(row.others, key=order.__getitem__)
            if order[earlier] > order[state]:
                break
            factor = row.others.pop(earlier)
            if earlier != state:
                known = rows[earlier]
                row = None if known is None else row.plus(factor, known)
            elif factor == 1:
                row = None
            else:
                row = _Row({}, (0, 0)).plus(1 / Fraction(1 - factor), row)
        rows[state] = row
    values: dict[int, Value] = {}
    for state, row in deadline.each(reversed(rows.items())):
        if row is None or any(values[other] == rule.infinite for other in row.others):
            values[state] = rule.infinite
            continue
        for other, factor in row.others.items():
            row = row.plus(factor, _Row({}, values[other]))
        values[state] = row.rest
    return values


def _first_row(policy: Mapping[int, Option], state: int, rule: Mean, outside: Outside) -> _Row | None:
    """What a state's option says of its mean costs; None where these are infinite."""
    move, end, outcomes = policy[state]
    if end is not None:
        value = rule.add(move.value, end)
        return None if value == rule.infinite else _Row({}, value)
    row, share = _Row({}, rule.lift(move.value)), Fraction(1, len(outcomes)) if len(outcomes) > 1 else 1
    for outcome in outcomes:
        inside = outcome.after in policy
        value = rule.lift(outcome.value) if inside else rule.add(outcome.value, outside(outcome.after))
        if value == rule.infinite:
            return None
        row = row.plus(share, _Row({outcome.after: 1} if inside else {}, value))
    return row


def _ends_first(policy: Mapping[int, Option]) -> Iterator[int]:
    """The states of a policy, each after those that it leads to, as far as runs do not return."""
    seen: set[int] = set()
    for root in policy:
        stack = [] if root in seen else [(root, iter(policy[root].outcomes))]
        seen.add(root)
        while stack:
            state, left = stack[-1]
            after = next(
                (move.after for move in left if move.after in policy and move.after not in seen), None
            )
            if after is None:
                stack.pop()
                yield state
            else:
                seen.add(after)
                stack.append((after, iter(policy[after].outcomes)))
