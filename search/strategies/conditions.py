"""Conditions on the calls that a strategy is for: each once, by name."""

from search.call.context import SearchContext
from search.strategies.call import Call
from serendipity.model.options import INFINITE, Options


def is_planned(call: Call) -> bool:
    """Whether ``pi_H`` is known, or not waited for."""
    return call.is_planned


def replans_freely(options: Options) -> bool:
    """Whether the human may go on as they like after a window, and keeps to ``pi_H`` in order before it."""
    return options.suffix == "replan" and options.preservation == "kernel" and not options.keep_prefix


def asks_for_nothing_else(context: SearchContext) -> bool:
    """Whether, beside that, nothing limits costs, robots have no goal, and nothing is announced."""
    options = context.options
    plain = replans_freely(options) and options.max_cost is None and not context.packed.in_time
    return plain and not context.task.robot_goal and not context.weights.announces


def goals_are_shared(call: Call) -> bool:
    """Whether what others change, too, decides on the goal: private distances say little then."""
    return call.context.distances_say_little


# -- the human's plan


def wants_first_plan(call: Call) -> bool:
    """Whether the human's optimal plan may take long, so that any plan of theirs is welcome before it."""
    if call.options.mode == "individual":
        return True
    return call.given is None and not is_for_team_first(call) and goals_are_shared(call)


def wants_human_plan(call: Call) -> bool:
    """Whether ``pi_H``, or the human's optimum, is to be found before all else."""
    if call.is_planned or is_for_team_first(call):
        return False
    return call.options.mode == "individual" or call.given is None


def has_first_plan(call: Call) -> bool:
    """The same, and a plan is at hand beside which the call can go on."""
    is_there = call.first is not None and call.first.plan is not None
    return is_there and call.options.mode != "individual" and wants_human_plan(call)


# -- what was known


def is_warm(call: Call) -> bool:
    """Whether a plan was known before."""
    return call.is_planned and bool(call.warm.steps)


def has_given_plan(call: Call) -> bool:
    """Whether the caller has said what the human does: they may gain something alone."""
    return call.given is not None and call.is_planned and not is_for_team_first(call)


# -- composite plans


def is_for_team(call: Call) -> bool:
    """Whether any composite plan of any length is a plan of the call."""
    options = call.options
    endless = options.mode == "composite" and options.horizon == INFINITE
    return (
        endless and options.max_cost is None and not call.task.robot_goal and not call.context.packed.in_time
    )


def is_for_team_first(call: Call) -> bool:
    """The same, and the kernel is asked before ``pi_H`` is known."""
    return is_for_team(call) and goals_are_shared(call) and call.context.team is not None


def is_for_kernel(call: Call) -> bool:
    """The same, and the kernel can be asked."""
    return call.is_planned and is_for_team(call) and call.context.team is not None


def is_for_team_beside_plan(call: Call) -> bool:
    """The same, while private distances may be enough for it."""
    return is_for_team(call) and not goals_are_shared(call) and call.plan is not None


def has_team(call: Call) -> bool:
    """Whether the kernel bounds what all agents pay together, where private distances say little."""
    if not call.is_planned or is_for_team(call):
        return False
    return goals_are_shared(call) and call.context.team is not None


def joint_plans_decide(call: Call) -> bool:
    """Whether every composite plan within ``T`` keeps the mode's rules, and its cost is its objective."""
    context, options = call.context, call.options
    if call.epochs is None or options.max_cost is not None:
        return False
    if context.weights.announces or context.packed.in_time:
        return False
    if not options.windowed:
        return True
    plain = not options.window_weight and options.max_window is None
    return replans_freely(options) and plain and not context.task.robot_goal


def joint_optimum_may_be_it(call: Call) -> bool:
    """Whether the joint optimum without a horizon may be the answer."""
    return has_team(call) and joint_plans_decide(call)


def joint_optimum_only_bounds(call: Call) -> bool:
    """Whether it is a bound, and suggests plans, but is no plan of the call."""
    return has_team(call) and not joint_plans_decide(call)


def joint_optimum_is_open(call: Call) -> bool:
    """Whether it may be the answer, and a limit came before it was found."""
    team = call.context.team if joint_optimum_may_be_it(call) else None
    return team is not None and team.planner.is_open


# -- windows


def short_windows_suffice(call: Call) -> bool:
    """Whether no window of more than one epoch can be better than what is known, where goals are shared."""
    windowed = call.is_planned and call.options.windowed and bool(call.plan)
    return windowed and goals_are_shared(call) and call.best.key < call.longer


def robots_only_leave_behind(call: Call) -> bool:
    """The same, and all that robots can do for the human is to leave something behind by then."""
    return short_windows_suffice(call) and asks_for_nothing_else(call.context)


def timetable_is_hopeful(call: Call) -> bool:
    """The same, and a good part of the epochs beside the human's timetable is done already."""
    return robots_only_leave_behind(call) and call.timetable is not None and call.timetable.is_hopeful


# -- what comes after the best plan


def compares_with_human(call: Call) -> bool:
    """Whether what the human does alone is still to be found, for the saving."""
    return is_for_team_first(call) and (call.plan is None or not call.knows_alone)


def has_ties(call: Call) -> bool:
    """Whether only the objective is known to be the best."""
    return call.is_settled and not call.is_done
