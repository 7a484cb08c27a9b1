"""The exact value of a policy: along the graph where it does not return, by elimination where it does."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from search.modes.assistance.game.game import Move
from search.modes.assistance.game.rules import ChoiceRule, Mean, Value
from serendipity.model.resources.deadline import Deadline


def components(nodes: Iterable[int], onward: Mapping[int, Collection[int]]) -> Iterator[list[int]]:
    """Strongly connected components of a graph (Tarjan 1972), those without a way out first."""
    order: dict[int, int] = {}
    lowest: dict[int, int] = {}
    open_nodes: list[int] = []
    inside: set[int] = set()
    for root in nodes:
        if root in order:
            continue
        stack: list[tuple[int, Iterator[int]]] = [(root, iter(onward[root]))]
        order[root] = lowest[root] = len(order)
        open_nodes.append(root)
        inside.add(root)
        while stack:
            node, left = stack[-1]
            successor = next(left, None)
            if successor is None:
                stack.pop()
                if stack:
                    parent = stack[-1][0]
                    lowest[parent] = min(lowest[parent], lowest[node])
                if lowest[node] == order[node]:
                    yield _take(node, open_nodes, inside)
            elif successor not in order:
                order[successor] = lowest[successor] = len(order)
                open_nodes.append(successor)
                inside.add(successor)
                stack.append((successor, iter(onward[successor])))
            elif successor in inside:
                lowest[node] = min(lowest[node], order[successor])


def _take(root: int, open_nodes: list[int], inside: set[int]) -> list[int]:
    component = []
    while True:
        node = open_nodes.pop()
        inside.discard(node)
        component.append(node)
        if node == root:
            return component


Number = int | Fraction
Row = tuple[int, dict[int, int], tuple[Number, Number]]
"""``n_i``, the coefficients ``m_ij`` by ``j``, the pair ``c_i``."""


def solve_linear(rows: Sequence[Row], deadline: Deadline) -> list[tuple[Fraction, Fraction]] | None:
    """The pairs of ``n_i x_i = sum_j m_ij x_j + c_i``, by elimination; None if these do not determine them.

    They do where every ``i`` leads out of the system in the end: its rows then sum to less
    than ``n_i`` somewhere on the way.
    """
    system: list[tuple[dict[int, Fraction], Fraction, Fraction]] = []
    for n, coefficients, (first, second) in rows:
        scaled = {j: Fraction(m, n) for j, m in coefficients.items()}
        system.append((scaled, Fraction(first) / n, Fraction(second) / n))
    for i in range(len(system)):
        own = 1 - system[i][0].pop(i, Fraction(0))
        if own == 0:
            return None
        row, first, second = system[i]
        system[i] = ({j: m / own for j, m in row.items()}, first / own, second / own)
        for k in range(len(system)):
            factor = system[k][0].pop(i, None) if k != i else None
            if factor is not None:
                deadline.tick()
                system[k] = _substitute(system[k], system[i], factor)
    return [(first, second) for _, first, second in system]


def _substitute(
    row: tuple[dict[int, Fraction], Fraction, Fraction],
    solved: tuple[dict[int, Fraction], Fraction, Fraction],
    factor: Fraction,
) -> tuple[dict[int, Fraction], Fraction, Fraction]:
    coefficients = row[0]
    for j, m in solved[0].items():
        coefficients[j] = coefficients.get(j, Fraction(0)) + factor * m
    return coefficients, row[1] + factor * solved[1], row[2] + factor * solved[2]


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
