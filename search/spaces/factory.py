"""Puts a windowed space together from the options (semantics 3.1, 3.3, 3.4)."""

from collections.abc import Callable, Collection, Mapping, Sequence

from search.bounds.achievers import Achievers, Provided
from search.bounds.first_interaction import (
    Bounds,
    FirstInteraction,
    Timed,
    no_bound,
    no_team_bound,
    survivors,
)
from search.bounds.prefix_bounds import FirstInteractionOnTheWay, PrefixBounds
from search.bounds.private_distances import Corridor, ways_through
from search.call.context import SearchContext
from search.engine.dominance import ParetoFront
from search.human.pattern_database import NOTHING_KNOWN
from search.human.plan_suffix import PlanSuffix
from search.human.strides import is_undisturbed
from search.human.suffix_rules import Lasting, Replan, Suffix
from search.packed.cost_vector import INFINITE_KEY, NEVER, CostLayout
from search.packed.due import Due
from search.packed.joint_actions import JointAction
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from search.packed.packings import human_facts
from search.spaces.unrestricted import Unrestricted
from search.spaces.windowed import AnyOfPlan, InLayers, Prefix, PrefixBound, PrivateRest, Windowed
from serendipity.model.options import Options
from serendipity.model.task.actions import Condition
from serendipity.model.task.task import HumanPlan


def window_space(
    context: SearchContext, plan: HumanPlan, horizon: int, most_cost: int | None, limit: int, *, idle: bool
) -> Windowed:
    """The space of plans with a window.

    Args:
        plan: ``pi_H``.
        horizon: ``T``, at least ``|pi_H|``.
        most_cost: largest scaled cost of an acceptable plan, or None.
        limit: key that a plan has to beat.
        idle: robots do nothing.
    """
    options = context.options
    team = context.team_bound
    is_private = team is no_team_bound
    walks = None if idle or not is_private else context.walks(plan)
    successors = context.successors(idle=idle) if walks is None else context.folded(walks)
    private, steps = (context.bound, context.steps) if is_private else (NOTHING_KNOWN, NOTHING_KNOWN)
    touches = context.interactions if is_private else None
    prefix: Prefix = prefix_rule(context, plan)
    on_the_way: PrefixBound = PrivateRest(len(plan), private, context.keys, horizon)
    untouched: Timed = no_bound
    if options.keep_prefix:
        prefix = AnyOfPlan(successors, context.packed, plan)
    elif is_private:
        keys = context.keys
        opened = [keys.of_start(t + 1, horizon) + keys.epoch_weight for t in range(len(plan))]
        along = BoundsAlong(context, plan, horizon, limit, opened, context.weights.robots, idle=idle)
        on_the_way, untouched = along.on_the_way, along.off_plan or no_bound
    return Windowed(
        initial=context.packed.init,
        idle=() if walks is None else (0,) * len(walks.fields),
        horizon=horizon,
        last=len(plan),
        max_window=options.max_window or horizon,
        most_cost=most_cost,
        keys=context.keys,
        successors=successors,
        bounds=Bounds(private, steps, untouched, touches, team),
        prefix=prefix,
        on_the_way=on_the_way,
        suffix=suffix_rule(context, plan),
        labels=ParetoFront(no_worse(context.keys, options, most_cost)),
        relevant=context.relevant,
        opens_late=context.packed.in_time and options.suffix == "replan" and options.preservation == "kernel",
    )


def free_space(
    context: SearchContext, horizon: int | None, most_cost: int | None, limit: int, *, idle: bool
) -> Unrestricted:
    """The space of plans without a window; arguments as above, and ``T`` may be None."""
    # What is announced may make a cheap node look dearer than one that exceeds max_cost in the end.
    announces = context.weights.announces
    compared = no_worse(context.keys, context.options, most_cost) if announces else None
    return Unrestricted(
        initial=context.packed.init,
        horizon=horizon,
        most_cost=most_cost,
        goals=context.goals,
        keys=context.keys,
        successors=context.successors(idle=idle),
        bounds=free_bounds(context, horizon, limit, idle=idle),
        labels=ParetoFront(compared),
    )


def no_worse(keys: CostLayout, options: Options, most_cost: int | None) -> Callable[[int, int], bool] | None:
    """The condition, beside the key, under which the first of two keys dominates the second; None: none."""
    if most_cost is None and options.max_window is None and options.preservation == "kernel":
        return None

    def compared(a: int, b: int) -> bool:
        return (
            keys.scaled_cost(a) <= keys.scaled_cost(b)
            and keys.length(a) <= keys.length(b)
            and keys.start_field(a) >= keys.start_field(b)
        )

    return compared


class BoundsAlong:
    """Bounds along ``pi_H`` and off it, up to the first touch that is not on the plan.

    The human's private fields follow ``pi_H``, so their part of the first is known in advance.

    Args:
        plan: ``pi_H``; empty where they are free from the start.
        horizon: ``T``, at least ``|pi_H|``.
        limit: key that a plan has to beat.
        opened: key increment of their freedom after ``0 .. |pi_H| - 1`` epochs, or at once.
        robots: key increment of a robots' op by the index of its cost.
        idle: robots do nothing.

    Attributes:
        on_the_way: holds while the human follows ``pi_H``.
        off_plan: holds after a window has opened; None where there is nothing to tell apart.
    """

    def __init__(
        self,
        context: SearchContext,
        plan: HumanPlan,
        horizon: int,
        limit: int,
        opened: Sequence[int],
        robots: Sequence[int],
        *,
        idle: bool,
    ) -> None:
        self._context = context
        self._horizon = horizon
        self._limit = limit
        steps, deadline = context.followed(plan), context.deadline
        transitions, followed = context.tables.transitions(deadline), [op for op, _ in steps]
        self._providers = Achievers(
            context.packed, transitions, context.interactions, robots, followed, deadline
        )
        self._sources: list[tuple[int, int]] = []  # key and state where a window opens, by epoch
        self._spent: list[int] = []
        self._corridors: list[tuple[int, int, Corridor, dict[int, int]]] = []  # from and to which epoch
        self._costs: dict[int, int] = {}
        self._follow(steps, opened)
        floor = [base + context.bound(at) for base, at in self._sources]
        reach = _reach(context, horizon, limit) if plan else horizon - 1
        self._openings = PrefixBounds(len(opened), reach, floor)
        """The human's totals, by need and by when the window opens."""
        self._explore()
        paying = None if idle else self._price_needs()
        provided = None if paying is None else self._refine(paying)
        needs: dict[int, Provided | None] = dict.fromkeys(self._openings.least)
        if provided is not None:
            needs = {**provided}
        outside = context.interactions.outside
        self.on_the_way = FirstInteractionOnTheWay(self._openings, self._spent, needs, outside)
        self.off_plan = None if provided is None else self._off_plan(provided)

    def _follow(self, steps: Sequence[tuple[Operator, JointAction]], opened: Sequence[int]) -> None:
        """What following ``pi_H`` costs, and where the human is before each of its epochs."""
        state, cost = self._context.packed.init, 0
        for number, opening in enumerate(opened):
            self._sources.append((cost + opening, state))
            self._spent.append(cost)
            for op, option in steps[number : number + 1]:
                state = state & op.keep | op.put
                # Who begins nothing any more waits for nothing.
                cost += 0 if op.action in self._context.packed.idling else option.weight

    def _explore(self) -> None:
        """The human's ways from each epoch of ``pi_H`` to touches, and on to the goal.

        Between two changes of ``pi_H`` to what others depend on, a need goes by one id.
        """
        ways, providers, openings = self._context.ways, self._providers, self._openings
        for first, end in providers.phases(len(self._sources)):
            corridor = ways.explore(self._sources[first:end], self._limit)
            ids = {providers.at(need, first): need for need in corridor.totals}
            openings.add(end, corridor.without, {i: corridor.totals[need] for i, need in ids.items()})
            self._corridors.append((first, end, corridor, ids))
        openings.latest = {
            i: self._horizon - 1 - ways.steps_after[providers.touched(i)] for i in openings.least
        }

    def _price_needs(self) -> list[int] | None:
        """Ids of the needs that may pay; None if they are too many to look at."""
        openings, providers = self._openings, self._providers
        self._costs = providers.costs(sorted(openings.least), self._pays)
        return survivors(
            self._costs, self._limit, lambda i, cost: openings.rough(i, cost, providers.epochs(cost))
        )

    def _pays(self, cost: int) -> bool:
        """Whether anything can pay for which robots need this cost, or more."""
        return cost + self._openings.least_after(self._providers.epochs(cost)) < self._limit

    def _refine(self, paying: Collection[int]) -> dict[int, Provided]:
        """What robots can do about the needs that pay even with the human's totals epoch by epoch."""
        mask = self._context.interactions.mask
        for first, end, corridor, ids in self._corridors:
            at = [(base, state & mask) for base, state in self._sources[first:end]]
            for i in ids.keys() & paying:
                totals = [corridor.totals[ids[i]]]
                if len(at) > 1:
                    rest = ways_through([corridor], ids[i], self._context.deadline)
                    totals = [base + rest.get(place, INFINITE_KEY) for base, place in at]
                self._openings.refine(i, first, totals)
        left = [i for i in paying if self._total(i) < self._limit]
        slack = {i: self._limit - self._openings.least[i] for i in left}
        return self._providers.provided(left, self._horizon, slack, self._openings.latest)

    def _total(self, i: int) -> int:
        """Least total of a plan that touches a need first."""
        cost = self._costs[i]
        return self._openings.total(i, cost, self._providers.epochs(cost))

    def _off_plan(self, provided: Mapping[int, Provided]) -> FirstInteraction:
        """The bound where the human does not follow ``pi_H``, over the needs that pay."""
        needs = [(self._providers.touched(i), what, self._total(i)) for i, what in provided.items()]
        corridors = [corridor for _, _, corridor, _ in self._corridors]
        return FirstInteraction(self._context.ways, corridors, needs)


def _reach(context: SearchContext, horizon: int, limit: int) -> int:
    """The most epochs of a window that can still beat ``limit``."""
    most = min(horizon, context.options.max_window or horizon)
    weight = context.keys.epoch_weight >> context.keys.objective_shift
    return min(most, (limit >> context.keys.objective_shift) // weight) if weight else most


def free_bounds(context: SearchContext, horizon: int | None, limit: int, *, idle: bool) -> Bounds:
    """Bounds where the human is free from the start."""
    untouched: Timed = no_bound
    team = context.team_bound
    if team is not no_team_bound:
        return Bounds(NOTHING_KNOWN, NOTHING_KNOWN, team=team)
    if not idle:
        last = NEVER if horizon is None else horizon
        along = BoundsAlong(context, (), last, limit, [0], context.weights.robots, idle=False)
        untouched = along.off_plan or no_bound
    return Bounds(context.bound, context.steps, untouched, context.interactions)


def prefix_rule(context: SearchContext, plan: HumanPlan) -> InLayers:
    """Rule 1: what the human may do before the window; where waiting costs, wait or rest."""
    packed = context.packed
    idle = [*context.followed(packed.idling)] if packed.prices_waiting else []
    steps = context.followed(plan)
    return InLayers([idle if idle and step[0].action in packed.idling else [step] for step in steps])


def suffix_rule(context: SearchContext, plan: HumanPlan, *, aside: bool = False) -> Suffix:
    """Rule 3 as the options have it; ``aside``: without regard to the robots' goal."""
    options, packed, goals = context.options, context.packed, context.goals
    theirs, both = packed.robot_goal, None if aside else context.alone_to_both
    if aside:
        theirs, goals = packed.condition(Condition()), tuple(goal for goal in goals if goal is not theirs)
    due = Due(packed, context.weights.team, strict=options.strict)
    if options.suffix == "subplan" or options.preservation == "state":
        own = None if options.preservation == "kernel" else _own_facts(packed)
        return PlanSuffix(packed, plan, context.weights.team, due, goals, own, context.deadline)
    lasts = packed.in_time and is_undisturbed(packed) and not both and not packed.awake
    if packed.clock_bit and not lasts:
        # Beside a script robots' goals may come true, or be lost, once the human is done: Lasting asks.
        theirs, both = packed.condition(Condition()), None
    replan = Replan(context.alone, both, theirs, packed.at_rest, context.keys)
    if lasts or (not packed.clock_bit and not (packed.in_time and (packed.awake or replan.both))):
        return replan
    return Lasting(replan, goals, due, packed)


def _own_facts(packed: PackedTask) -> frozenset[int]:
    """The facts of the human's own domain, but for those that say what is due, and whether they rest."""
    task = packed.task
    progress = {fact for fact, _ in task.due}
    return human_facts(task) - progress - {fact for i in packed.idling[:1] for fact in task.actions[i].pre}
