"""Everything looked at solved at once, where runs may return to a state.

Robust: AND-OR Dijkstra (Knuth 1977), a choice is settled in the order of its value.
Expected: policy iteration among policies that end with certainty (Bertsekas and
Tsitsiklis 1991).  Only strict improvements are made, so policies keep ending although
some moves are free: in a set of states that is never left, strict improvement
somewhere would make the mean of the values fall below itself.
"""

from heapq import heappop, heappush

from search.assistance.evaluate import Option, evaluate, option_value
from search.assistance.graph import Graph
from search.assistance.rules import Mean, Value
from search.clock import Clock

Model = dict[int, list[Option]]


def solve_all(graph: Graph, clock: Clock) -> None:
    """Raise all bounds to the values of what has been looked at, and set ``graph.pick``."""
    model = {state: [graph.option(state, move) for move in moves] for state, moves in graph.choices.items()}
    solve = _mean if isinstance(graph.rule, Mean) else _worst
    values, policy = solve(graph, model, clock)
    for state in model:
        value = values.get(state, graph.rule.infinite)
        if value > graph.low[state]:
            graph.low[state] = value
        if state in policy:
            graph.pick[state] = policy[state].move
    for reply in graph.replies:
        graph.back_up_reply(reply)


Solved = tuple[dict[int, Value], dict[int, Option]]


def _worst(graph: Graph, model: Model, clock: Clock) -> Solved:
    rule = graph.rule
    waiting: dict[int, list[tuple[int, Option]]] = {}
    missing: dict[tuple[int, Option], int] = {}
    candidates: dict[int, tuple[Value, Option]] = {}
    queue: list[tuple[Value, int]] = []
    values: dict[int, Value] = {}

    def value_of(state: int) -> Value:
        return values[state] if state in model else graph.choice_value(state)

    def offer(state: int, option: Option) -> None:
        value = option_value(option, rule, value_of)
        if value < rule.infinite and (state not in candidates or value < candidates[state][0]):
            candidates[state] = (value, option)
            heappush(queue, (value, state))

    for state, options in model.items():
        for option in options:
            inside = {move.after for move in option.outcomes if move.after in model}
            if not inside:
                offer(state, option)
            for after in inside:
                waiting.setdefault(after, []).append((state, option))
            missing[state, option] = len(inside)
    while queue:
        value, state = heappop(queue)
        if state in values:
            continue
        if not len(values) % 256:
            clock.check()
        values[state] = value
        for parent in waiting.get(state, ()):
            missing[parent] -= 1
            if not missing[parent] and parent[0] not in values:
                offer(*parent)
    return values, {state: candidates[state][1] for state in values}


def _mean(graph: Graph, model: Model, clock: Clock) -> Solved:
    rule = graph.rule
    model = _certain(graph, model, clock)
    policy = _attracted(graph, model)
    while True:
        clock.check()
        values = evaluate(policy, rule, graph.choice_value, clock)

        def value_of(state: int, values: dict[int, Value] = values) -> Value:
            return values[state] if state in model else graph.choice_value(state)

        improved = False
        for state, options in model.items():
            best = min(options, key=lambda option: option_value(option, rule, value_of))
            if option_value(best, rule, value_of) < values[state]:
                policy[state] = best
                improved = True
        if not improved:
            return values, policy


def _certain(graph: Graph, model: Model, clock: Clock) -> Model:
    """The states from which some policy ends with certainty, with the options that stay among them."""
    while True:
        clock.check()
        kept = {
            state: [option for option in options if _stays(graph, model, option)]
            for state, options in model.items()
        }
        reached = _attracted(graph, kept)
        if len(reached) == len(model):
            return kept
        model = {state: kept[state] for state in reached}


def _stays(graph: Graph, model: Model, option: Option) -> bool:
    """Whether no outcome is a state that can't end with certainty."""
    if option.end is not None:
        return bool(option.end < graph.rule.infinite)
    return all(
        move.after in model or (move.after not in graph.choices and _finite(graph, move.after))
        for move in option.outcomes
    )


def _finite(graph: Graph, state: int) -> bool:
    return bool(graph.choice_value(state) < graph.rule.infinite)


def _attracted(graph: Graph, model: Model) -> dict[int, Option]:
    """States that may end under some policy, each with an option that brings the end nearer."""
    waiting: dict[int, list[tuple[int, Option]]] = {}
    policy: dict[int, Option] = {}
    pending: list[int] = []
    for state, options in model.items():
        for option in options:
            ends = option.end is not None or any(move.after not in model for move in option.outcomes)
            if ends and state not in policy:
                policy[state] = option
                pending.append(state)
            for move in option.outcomes:
                waiting.setdefault(move.after, []).append((state, option))
    while pending:
        for state, option in waiting.get(pending.pop(), ()):
            if state not in policy:
                policy[state] = option
                pending.append(state)
    return policy
