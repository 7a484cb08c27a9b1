"""Puts a windowed space together from the options (semantics 3.1, 3.3, 3.4)."""

from collections.abc import Callable, Sequence

from search.context import SearchContext
from search.engine.dominance import ParetoFront
from search.heuristics.achievers import Achievers
from search.heuristics.first_interaction import Bounds, FirstInteraction, Timed, no_bound, survivors
from search.heuristics.prefix_bounds import FirstInteractionOnTheWay, PrefixBounds
from search.heuristics.private_distances import NEVER
from search.human.suffix_rules import Preserved, Replan, Subplan, Suffix
from search.packed.cost_vector import INFINITE_KEY, CostLayout
from search.packed.operators import Operator
from search.packed.packings import human_facts
from search.spaces.windowed import AnyOfPlan, Prefix, Timetable, Windowed
from serendipity.model.options import Options
from serendipity.model.task import HumanPlan


def window_space(
    context: SearchContext, plan: HumanPlan, horizon: int, most_cost: int | None, limit: int, *, idle: bool
) -> Windowed:
    """The space of plans with a window.

    Args:
        context: of the call.
        plan: ``pi_H``.
        horizon: ``T``, at least ``|pi_H|``.
        most_cost: largest scaled cost of an acceptable plan, or None.
        limit: key that a plan has to beat.
        idle: robots do nothing.
    """
    options = context.options
    walks = None if idle else context.walks(plan)
    successors = context.successors(idle=idle) if walks is None else context.folded(walks)
    prefix: Prefix
    if options.keep_prefix:
        untouched: Timed = no_bound
        prefix = AnyOfPlan(successors, context.task, plan, context.bound, context.keys, horizon)
    else:
        keys = context.keys
        opened = [keys.of_start(t + 1, horizon) + keys.epoch_weight for t in range(len(plan))]
        on_the_way, helped = bounds_along(
            context, plan, horizon, limit, opened, context.weights.robots, idle=idle
        )
        untouched = helped or no_bound
        prefix = Timetable(context.followed(plan), on_the_way)
    return Windowed(
        initial=context.packed.init,
        idle=() if walks is None else (0,) * len(walks.fields),
        horizon=horizon,
        max_window=options.max_window or horizon,
        most_cost=most_cost,
        keys=context.keys,
        successors=successors,
        bounds=Bounds(context.bound, context.steps, untouched, context.interactions),
        prefix=prefix,
        suffix=suffix_rule(context, plan),
        labels=ParetoFront(no_worse(context.keys, options, most_cost)),
    )


def no_worse(keys: CostLayout, options: Options, most_cost: int | None) -> Callable[[int, int], bool] | None:
    """What else the first key must not be worse in, to dominate the second."""
    if most_cost is None and options.max_window is None and options.preservation == "kernel":
        return None

    def compared(a: int, b: int) -> bool:
        return (
            keys.scaled_cost(a) <= keys.scaled_cost(b)
            and keys.length(a) <= keys.length(b)
            and keys.start_field(a) >= keys.start_field(b)
        )

    return compared


def bounds_along(
    context: SearchContext,
    plan: HumanPlan,
    horizon: int,
    limit: int,
    opened: Sequence[int],
    robots: Sequence[int],
    *,
    idle: bool,
) -> tuple[FirstInteractionOnTheWay, FirstInteraction | None]:
    """Bounds along ``pi_H`` and off it, up to the first touch that is not on the plan.

    His private fields follow ``pi_H``, so his part of the first is known in advance.  The
    second is None where there is nothing to tell apart.

    Args:
        context: of the call.
        plan: ``pi_H``.
        horizon: ``T``, at least ``|pi_H|``.
        limit: key that a plan has to beat.
        opened: key increment of opening a window after ``0 .. |pi_H| - 1`` epochs.
        robots: key increment of a robots' op by the index of its cost.
        idle: robots do nothing.
    """
    ways, outside = context.ways, context.interactions.outside
    steps = context.followed(plan)
    followed = [op for op, _ in steps]
    providers = _achievers(context, robots, followed)
    state, cost = context.packed.init, 0
    sources, spent = [], []
    for epoch, (op, option) in enumerate(steps):
        sources.append((cost + opened[epoch], state))
        spent.append(cost)
        state = state & op.keep | op.put
        cost += option.weight
    floor = [base + context.bound(at) for base, at in sources]
    openings = PrefixBounds(len(plan), _reach(context, horizon, limit), floor)
    corridors = []
    for first, end in providers.phases(len(plan)):
        corridor = ways.explore(sources[first:end], limit)
        ids = {providers.at(need, first): need for need in corridor.totals}
        openings.add(end, corridor.without, {i: corridor.totals[need] for i, need in ids.items()})
        corridors.append((first, end, corridor, ids))
    least = openings.least
    openings.latest = {i: horizon - 1 - ways.steps_after[providers.touched(i)] for i in least}
    if idle or not least:
        return FirstInteractionOnTheWay(openings, spent, dict.fromkeys(least), outside), None

    def pays(cost: int) -> bool:
        return cost + openings.least_after(providers.epochs(cost)) < limit

    costs = providers.costs(sorted(least), pays)
    paying = survivors(costs, limit, lambda i, cost: openings.rough(i, cost, providers.epochs(cost)))
    if paying is None:
        return FirstInteractionOnTheWay(openings, spent, dict.fromkeys(least), outside), None
    for first, end, corridor, ids in corridors:
        for i in ids.keys() & paying:
            rest = corridor.through(ids[i])
            at = [(base, state & context.interactions.mask) for base, state in sources[first:end]]
            openings.refine(i, first, [base + rest.get(place, INFINITE_KEY) for base, place in at])
    paying = [i for i in paying if openings.total(i, costs[i], providers.epochs(costs[i])) < limit]
    slack = {i: limit - least[i] for i in paying}
    provided = providers.provided(paying, horizon, slack, openings.latest)
    off_plan = [
        (providers.touched(i), provided[i], openings.total(i, costs[i], providers.epochs(costs[i])))
        for i in paying
    ]
    return FirstInteractionOnTheWay(openings, spent, {**provided}, outside), FirstInteraction(
        context.bound, ways, off_plan, horizon
    )


def _achievers(context: SearchContext, weights: Sequence[int], followed: Sequence[Operator]) -> Achievers:
    deadline = context.deadline
    transitions = context.tables.robots.transitions(deadline)
    return Achievers(context.packed, transitions, context.interactions, weights, followed, deadline)


def _reach(context: SearchContext, horizon: int, limit: int) -> int:
    """The most epochs of a window that can still beat ``limit``."""
    most = min(horizon, context.options.max_window or horizon)
    weight = context.keys.epoch_weight >> context.keys.objective_shift
    return min(most, (limit >> context.keys.objective_shift) // weight) if weight else most


def free_bounds(context: SearchContext, horizon: int | None, limit: int, *, idle: bool) -> Bounds:
    """Bounds where the human is free from the start."""
    untouched: Timed = no_bound
    last = NEVER if horizon is None else horizon
    if not idle:
        ways = context.ways
        providers = _achievers(context, context.weights.robots, ())
        least = ways.explore([(0, context.packed.init)], limit).totals

        def total(need: int, cost: int) -> int:
            in_time = providers.epochs(cost) < last - ways.steps_after[need]
            return least[need] + cost if in_time else INFINITE_KEY

        start = min(least.values(), default=limit)

        def pays(cost: int) -> bool:
            return start + cost < limit and providers.epochs(cost) < last

        costs = providers.costs(sorted(least), pays)
        paying = survivors(costs, limit, total)
        if paying is not None:
            slack = {need: limit - least[need] for need in paying}
            latest = {need: last - 1 - ways.steps_after[need] for need in paying}
            provided = providers.provided(paying, last, slack, latest)
            needs = [(need, provided[need], total(need, costs[need])) for need in paying]
            untouched = FirstInteraction(context.bound, ways, needs, last)
    return Bounds(context.bound, context.steps, untouched, context.interactions)


def suffix_rule(context: SearchContext, plan: HumanPlan) -> Suffix:
    """Rule 3 as the options have it."""
    options, task, packed = context.options, context.task, context.packed
    weights = [option.weight for _, option in context.followed(plan)]
    goals = list(context.goals)
    if options.preservation == "state":
        own = human_facts(task)
        expected = [sorted(own & state) for state in task.replay_alone(plan)]
        return Preserved(packed, plan, weights, goals, expected)
    if options.suffix == "subplan":
        return Subplan(packed, plan, weights, goals, context.deadline)
    return Replan(context.alone, context.alone_to_both, packed.robot_goal, context.keys)
