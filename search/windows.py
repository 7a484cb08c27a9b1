"""Puts a windowed space together from the options (SPEC 3.1, 3.3, 3.4)."""

from collections.abc import Callable

from search.encoding import human_facts
from search.keys import Keys
from search.labels import Labels
from search.suffix import Preserved, Replan, Subplan, Suffix
from search.successors import Successors
from search.tables import Tables
from search.windowed import AnyOfPlan, Prefix, Timetable, Windowed
from serendipity.model.options import Options
from serendipity.model.task import HumanPlan


def window_space(
    tables: Tables, plan: HumanPlan, horizon: int, most_cost: int | None, *, idle: bool
) -> Windowed:
    """The space of plans with a window.

    Args:
        tables: tables of the call.
        plan: ``pi_H``.
        horizon: ``T``, at least ``|pi_H|``.
        most_cost: largest scaled cost of an acceptable plan, or None.
        idle: robots do nothing.
    """
    options = tables.options
    no_worse = _no_worse(tables.keys, options, most_cost)
    successors = tables.successors(idle=idle)
    return Windowed(
        initial=tables.encoding.init,
        horizon=horizon,
        max_window=options.max_window or horizon,
        most_cost=most_cost,
        keys=tables.keys,
        successors=successors,
        bound=tables.bound,
        prefix=_prefix(tables, plan, horizon, successors),
        suffix=_suffix(tables, plan),
        labels=Labels(no_worse),
    )


def _no_worse(
    keys: Keys, options: Options, most_cost: int | None
) -> Callable[[int, int], bool] | None:
    """What else the first key must not be worse in, to dominate the second."""
    if most_cost is None and options.max_window is None and options.preservation == "kernel":
        return None

    def no_worse(a: int, b: int) -> bool:
        return (
            keys.scaled_cost(a) <= keys.scaled_cost(b)
            and keys.length(a) <= keys.length(b)
            and keys.start_field(a) >= keys.start_field(b)
        )

    return no_worse


def _prefix(tables: Tables, plan: HumanPlan, horizon: int, successors: Successors) -> Prefix:
    if tables.options.keep_prefix:
        opening = tables.keys.epoch_weight + tables.keys.of_start(len(plan), horizon)
        return AnyOfPlan(
            successors=successors,
            planned=frozenset(plan),
            last=len(plan),
            bound=tables.bound,
            opening=opening,
        )
    return Timetable(tables.followed(plan), _bounds_along(tables, plan, horizon))


def _bounds_along(tables: Tables, plan: HumanPlan, horizon: int) -> list[int]:
    """Least key increment after ``0 .. |pi_H| - 1`` epochs: some window still has to open."""
    steps = tables.followed(plan)
    states = [tables.encoding.init]
    for op, _ in steps:
        states.append(states[-1] & op.keep | op.put)
    bounds = [0] * len(plan)
    for epoch in range(len(plan) - 1, -1, -1):
        opening = tables.keys.of_start(epoch + 1, horizon) + tables.keys.epoch_weight
        bounds[epoch] = opening + tables.bound(states[epoch])
        if epoch + 1 < len(plan):
            bounds[epoch] = min(bounds[epoch], steps[epoch][1].weight + bounds[epoch + 1])
    return bounds


def _suffix(tables: Tables, plan: HumanPlan) -> Suffix:
    options, task, packed = tables.options, tables.task, tables.encoding
    weights = [option.weight for _, option in tables.followed(plan)]
    goals = list(tables.goals)
    if options.preservation == "state":
        own = human_facts(task)
        expected = [sorted(own & state) for state in task.replay_alone(plan)]
        return Preserved(packed, plan, weights, goals, expected)
    if options.suffix == "subplan":
        return Subplan(packed, plan, weights, goals)
    return Replan(tables.alone, tables.alone_to_both, packed.robot_goal, tables.keys)
