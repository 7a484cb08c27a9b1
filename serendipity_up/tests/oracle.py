"""Optima by unified-planning's own simulator: every state is visited."""

from fractions import Fraction
from heapq import heappop, heappush
from itertools import count

from unified_planning.engines.sequential_simulator import UPSequentialSimulator
from unified_planning.model import FNode, Problem, State


def least_cost(problem: Problem) -> Fraction | None:
    """What an optimal plan costs, None where there is none."""
    simulator = UPSequentialSimulator(problem)
    metric = problem.quality_metrics[0]
    fluents = [f for f in problem.initial_values if f.type.is_bool_type() or f.type.is_user_type()]

    def key(state: State) -> tuple[FNode, ...]:
        return tuple(state.get_value(fluent) for fluent in fluents)

    numbers = count()
    start = simulator.get_initial_state()
    queue = [(Fraction(0), next(numbers), start)]
    best = {key(start): Fraction(0)}
    while queue:
        cost, _, state = heappop(queue)
        if simulator.is_goal(state):
            return cost
        if cost > best[key(state)]:
            continue
        for action, parameters in simulator.get_applicable_actions(state):
            after = simulator.apply(state, action, parameters)
            assert after is not None
            price = Fraction(1)
            if metric.is_minimize_action_costs():
                expression = metric.get_action_cost(action)
                values = dict(zip(action.parameters, parameters, strict=True))
                ground = expression.substitute(values)
                price = Fraction(_value(ground, state))
            new = cost + price
            if new < best.get(key(after), new + 1):
                best[key(after)] = new
                heappush(queue, (new, next(numbers), after))
    return None


def _value(node: FNode, state: State) -> Fraction:
    if node.is_constant():
        return Fraction(node.constant_value())
    if node.is_plus():
        return sum((_value(part, state) for part in node.args), Fraction(0))
    return Fraction(state.get_value(node).constant_value())
