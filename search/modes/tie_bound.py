"""A lower bound on all answers, whichever optimal plan the human follows (semantics 1).

All their optimal plans are as long and cost as much, so one search does for them: before the
window they do, in each epoch, anything that some optimal plan does then.  That allows at least
what each plan allows.  A window of n epochs is answered only if it saves at least (n - 1) K.
"""

from fractions import Fraction

from search.bounds.first_interaction import Bounds
from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.engine.best_first import Incumbent, solve_space
from search.engine.dominance import ParetoFront
from search.human.plan_graph import PlanGraph
from search.spaces.factory import no_worse, suffix_rule
from search.spaces.windowed import InLayers, PrivateRest, Windowed
from search.strategies.portfolio import solve
from serendipity.model.errors import LIMITS
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.horizon import horizon_of


def least_over_ties(
    prepared: PreparedTask, options: Options, graph: PlanGraph, deadline: Deadline
) -> Fraction | None:
    """A lower bound on the cost of the answers to all of the human's optimal plans; None if time is up.

    Args:
        prepared: the task; robots have no goals of their own.
        options: of the call, in mode ``serendipity`` or ``communication``.
        graph: their optimal plans from the initial state.
    """
    horizon = int(horizon_of(prepared.task, options, graph.canonical()))
    replans = options.suffix == "replan" and options.preservation == "kernel"
    try:
        if options.mode == "serendipity" and options.human_model == "omniscient" and replans and graph.edges:
            return _by_windows(prepared, options, graph, horizon, deadline)
    except LIMITS:
        return None
    told = Options(
        mode="communication", discount=options.discount, horizon=horizon, interference=options.interference
    )
    *_, outcome = solve(prepared, told, deadline=deadline)
    return outcome.cost if outcome.status == "optimal" else None


def _by_windows(
    prepared: PreparedTask, options: Options, graph: PlanGraph, horizon: int, deadline: Deadline
) -> Fraction:
    plan = graph.canonical()
    most = horizon if options.max_window is None else options.max_window
    if options.window_weight:
        most = min(most, int(prepared.task.cost_of(plan) / options.window_weight) + 1)
    free = options.but(window_weight=0, max_window=most, max_cost=None)
    context = SearchContext(prepared, free, deadline)
    steps = [context.followed(tuple(sorted(layer))) for layer in graph.layers()]
    space = Windowed(
        initial=context.packed.init,
        horizon=horizon,
        last=len(steps),
        max_window=most,
        keys=context.keys,
        successors=context.successors(),
        bounds=Bounds(context.bound, context.steps, touches=context.interactions),
        prefix=InLayers(steps),
        on_the_way=PrivateRest(len(steps), context.bound, context.keys, horizon),
        suffix=suffix_rule(context, plan),
        labels=ParetoFront(no_worse(context.keys, free, None)),
        relevant=context.relevant,
    )
    best = Incumbent(sum(option.weight for _, option in context.followed(plan)))
    solve_space(space, best, deadline)
    return context.keys.cost(best.key)
