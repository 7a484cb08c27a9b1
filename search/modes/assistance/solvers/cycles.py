"""Everything looked at solved at once, where runs may return to a state.

AND-OR Dijkstra (Knuth 1977), a choice is settled in the order of its value.
Expected: policy iteration among policies that end with certainty (Bertsekas and
Tsitsiklis 1991).  Only strict improvements are made, so policies keep ending although
some moves are free: in a set of states that is never left, strict improvement
somewhere would make the mean of the values fall below itself.
"""

from search.modes.assistance.game.rules import Mean, Value
from search.modes.assistance.solvers.evaluate import Option, evaluate, forced, option_value
from search.modes.assistance.solvers.graph import Graph
from serendipity.model.resources.deadline import Deadline

Model = dict[int, list[Option]]


def solve_all(graph: Graph, deadline: Deadline) -> None:
    """Raise all bounds to the values of what has been looked at, and set ``graph.pick``."""
    model: Model = {
        state: [option for move in moves for option in graph.options(state, move)]
        for state, moves in deadline.each(graph.choices.items())
    }
    if isinstance(graph.rule, Mean):
        values, policy = _mean(graph, model, deadline)
    else:
        values, policy = forced(model, graph.rule, graph.choice_value, deadline)
    for state in model:
        graph.low[state] = max(graph.low[state], values.get(state, graph.rule.infinite))
        if state in policy:
            graph.pick[state] = policy[state]
    for reply in deadline.each(graph.replies):
        graph.back_up_reply(reply)


def _mean(graph: Graph, model: Model, deadline: Deadline) -> tuple[dict[int, Value], dict[int, Option]]:
    """Values and options of all states from which some policy ends with certainty."""
    rule = graph.rule
    model = _certain(graph, model, deadline)
    policy = _attracted(model, deadline)
    while True:
        deadline.check()
        values = evaluate(policy, rule, graph.choice_value, deadline)

        def value_of(state: int, values: dict[int, Value] = values) -> Value:
            return values[state] if state in model else graph.choice_value(state)

        improved = False
        for state, options in deadline.each(model.items()):
            best = min(options, key=lambda option: option_value(option, rule, value_of))
            if option_value(best, rule, value_of) < values[state]:
                policy[state] = best
                improved = True
        if not improved:
            return values, policy


def _certain(graph: Graph, model: Model, deadline: Deadline) -> Model:
    """The states from which some policy ends with certainty, with the options that stay among them."""
    while True:
        kept: Model = {
            state: [option for option in options if _stays(graph, model, option)]
            for state, options in deadline.each(model.items())
        }
        reached = _attracted(kept, deadline)
        if len(reached) == len(model):
            return kept
        model = {state: kept[state] for state in reached}


def _stays(graph: Graph, model: Model, option: Option) -> bool:
    """Whether no outcome is a state that can't end with certainty."""
    if option.end is not None:
        return bool(option.end < graph.rule.infinite)
    return all(
        at in model or (at not in graph.choices and graph.choice_value(at) < graph.rule.infinite)
        for _, at, _ in option.outcomes
    )


def _attracted(model: Model, deadline: Deadline) -> dict[int, Option]:
    """States that may end under some policy, each with an option that brings the end nearer."""
    waiting: dict[int, list[tuple[int, Option]]] = {}
    policy: dict[int, Option] = {}
    pending: list[int] = []
    for state, options in deadline.each(model.items()):
        for option in options:
            ends = option.end is not None or any(move.after not in model for move in option.outcomes)
            if ends and state not in policy:
                policy[state] = option
                pending.append(state)
            for move in option.outcomes:
                waiting.setdefault(move.after, []).append((state, option))
    while pending:
        deadline.tick()
        for state, option in waiting.get(pending.pop(), ()):
            if state not in policy:
                policy[state] = option
                pending.append(state)
    return policy
