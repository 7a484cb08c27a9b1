"""The exact value of a policy: along the graph where it does not return, by elimination where it does."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

from search.modes.assistance.game.game import Move
from search.modes.assistance.game.rules import ChoiceRule, Mean, Value
from search.modes.assistance.solvers.components import components
from search.modes.assistance.solvers.linear import Row, solve_linear
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
    """Values of all states of a policy; infinite where a run may not end.

    Args:
        policy: per state the option chosen.
        rule: how the prime's moves count.
        outside: values of states that are not in the policy.
        deadline: polled while they are worked out.
    """
    values: dict[int, Value] = {}

    def value_of(state: int) -> Value:
        return values[state] if state in policy else outside(state)

    onward = {
        state: [move.after for move in option.outcomes if move.after in policy]
        for state, option in policy.items()
    }
    for component in components(policy, onward):
        deadline.check()
        first = component[0]
        if len(component) == 1 and first not in onward[first]:
            values[first] = option_value(policy[first], rule, value_of)
        elif isinstance(rule, Mean):
            values.update(_returning(policy, component, rule, value_of, deadline))
        else:
            values.update(dict.fromkeys(component, rule.infinite))
    return values


def _returning(
    policy: Mapping[int, Option],
    component: list[int],
    rule: ChoiceRule,
    value_of: Outside,
    deadline: Deadline,
) -> dict[int, Value]:
    """Mean values of states that a run may visit again."""
    index = {state: i for i, state in enumerate(component)}
    rows: list[Row] = []
    for state in component:
        move, _, outcomes = policy[state]
        coefficients: dict[int, int] = {}
        total = rule.lift(len(outcomes) * move.value)
        for outcome in outcomes:
            if outcome.after in index:
                inside = index[outcome.after]
                coefficients[inside] = coefficients.get(inside, 0) + 1
                part = rule.lift(outcome.value)
            else:
                part = rule.add(outcome.value, value_of(outcome.after))
            total = (total[0] + part[0], total[1] + part[1])
        if total[0] >= rule.infinite[0]:
            return dict.fromkeys(component, rule.infinite)
        rows.append((len(outcomes), coefficients, total))
    solved = solve_linear(rows, deadline)
    if solved is None:
        return dict.fromkeys(component, rule.infinite)
    return {state: solved[i] for state, i in index.items()}
