"""The human alone: ``pi_H``, and what a call knows of it before robots come in."""

from collections.abc import Iterator

from search.engine.best_first import Incumbent, solve_space
from search.packed.cost_vector import INFINITE_KEY
from search.strategies.call import Allowance, Call
from search.strategies.conditions import is_for_team_first
from search.strategies.first_answer import FirstAnswer
from search.strategies.outcome import answered
from search.strategies.warm_start import replayed
from serendipity.model.errors import LimitReachedError


def first_plan(call: Call, _: Allowance) -> Iterator[None]:
    """Some plan of the human's, by a greedy search, and doing nothing beside it."""
    call.first = FirstAnswer(call.context, call.given, call.warm)
    plan = call.first.plan
    if plan is not None and (call.options.mode == "individual" or call.first.beside(plan) is not None):
        yield


def optimal_plan(call: Call, part: Allowance) -> None:
    """The human's canonical plan; at a limit of this part alone, the best plan that was come across."""
    try:
        found = call.under(part.deadline).canonical_plan()
    except LimitReachedError:
        call.context.deadline.check()
        plan = None if call.first is None else call.first.best
        if plan is None or call.options.mode == "individual":
            raise
        call.follow(plan, optimal=False)
        return
    if call.options.mode == "individual":
        call.optimum = found
        call.is_done = True
    elif found is not None:
        call.follow(found.actions, optimal=True)
    elif call.options.windowed or call.options.mode == "serendipity":
        call.refuse("no-human-plan")
    else:
        call.follow(None, optimal=True)


def known_plan(call: Call, part: Allowance) -> None:
    """The rest of the last answer, where it is a plan of this call."""
    context = call.under(part.deadline)
    found = replayed(context, call.plan or (), call.epochs, call.most_cost, call.warm)
    if found is not None:
        call.offer(found)  # told once it is known what the human gains alone


def plan_alone(call: Call, part: Allowance) -> None:
    """The human's gain alone, where the plan that is given is not an optimal one (semantics 1)."""
    plan = call.plan
    assert plan is not None and call.given is not None, "it is given"
    optimum = call.context.alone.key(call.context.packed.init)
    least = call.keys.cost(optimum) if call.least_alone is None else call.least_alone
    call.is_improvable = call.task.cost_of(plan) > least
    if call.is_improvable and _may_turn_at_once(call, optimum):
        # Then what they gain alone is known, and what robots gain has to have a smaller objective.
        window = call.keys.epoch_weight + call.keys.of_start(len(plan), int(call.horizon))
        call.idle = Incumbent(optimum + window)
        call.offer(call.idle)
    elif call.is_improvable:
        alone = call.unhelped()
        known = alone.key
        solve_space(call.space(part.deadline, known, idle=True), alone, part.deadline)
        if not call.task.robot_goal:
            call.idle = alone
        elif alone.key < known:
            call.unaided = alone
        call.offer(alone)
    call.knows_alone = True


def _may_turn_at_once(call: Call, optimum: int) -> bool:
    """Whether they may turn to an optimal plan in a window of one epoch, and robots have no goal."""
    options = call.options
    any_suffix = options.suffix == "replan" and options.preservation == "kernel"
    free = options.mode == "serendipity" and any_suffix and options.max_cost is None
    free = free and not call.context.packed.clock_bit  # which may undo what they reach
    fits = call.epochs is not None and call.keys.actions(optimum) <= call.epochs
    return free and fits and not call.task.robot_goal


def first_bound(call: Call, _: Allowance) -> Iterator[None]:
    """A bound on every plan by what the human has to do themselves; the end where that is known to be all."""
    if not is_for_team_first(call):
        call.raise_bound(call.least())
    if call.is_known_best or (call.epochs == 0 and answered(call).key < INFINITE_KEY):
        call.finish()
    yield


def saving(call: Call, part: Allowance) -> None:
    """The human's plan alone, for the saving of an answer that did not have to wait for it."""
    optimal = call.under(part.deadline).canonical_plan()
    call.compare(None if optimal is None else optimal.actions)
