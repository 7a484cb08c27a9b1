"""The answer to a call, by what is known of it (semantics 3)."""

from contextlib import suppress
from fractions import Fraction

from search.engine.best_first import Incumbent
from search.engine.paths import path_sets, plan_steps, whole_plan
from search.packed.cost_vector import INFINITE_KEY
from search.packed.parallelise import schedule
from search.strategies.call import Call
from search.strategies.first_answer import optimal_plan_alone
from serendipity.model.answers.answer import Answer, Status, saved
from serendipity.model.errors import LIMITS
from serendipity.model.task.plans import Step, Window


def answer_of(call: Call) -> Answer:
    """The answer, as far as it is known."""
    return _answer_of(call)._replace(tried=tuple(call.tried))


def _answer_of(call: Call) -> Answer:
    if call.refusal is not None:
        return Answer("infeasible", reason=call.refusal)
    first, is_alone = call.first, call.options.mode == "individual"
    if is_alone and call.is_done:
        return optimal_plan_alone(call.task, call.given, call.optimum)
    if is_alone or not call.is_planned:
        if first is None:
            return Answer("unknown", reason=call.limit)
        return first.alone(call.limit) if is_alone else first.last(call.limit)
    return _outcome(call)


def helps(call: Call) -> bool:
    """Whether the incumbent is an opportunity: cheaper than the best with robots idle."""
    if call.best.key == INFINITE_KEY or call.plan is None:
        return False
    if not call.knows_alone:
        return _surely_helps(call)
    shift = call.keys.cost_shift  # objective, then cost
    if call.unaided.key < INFINITE_KEY and call.best.key >> shift >= call.unaided.key >> shift:
        return False
    return call.idle.key == INFINITE_KEY or call.keys.cost(call.best.key) < call.keys.cost(call.idle.key)


def _surely_helps(call: Call) -> bool:
    """Whether the incumbent beats a bound on what the human pays alone, as long as no more is known."""
    if call.given and call.task.robot_goal:
        return False  # what robots do for it without helping counts, too
    alone = INFINITE_KEY
    with suppress(*LIMITS):
        alone = call.context.alone.least(call.context.packed.init)
    if alone >= INFINITE_KEY:
        return False
    if call.keys.cost(call.best.key) >= call.keys.cost(alone):
        return False
    # A human who turns to a better plan alone needs a window, too, and the best objective is answered.
    turned = call.keys.objective(alone) + call.options.window_weight
    return not call.given or call.keys.objective(call.best.key) < turned


def answered(call: Call) -> Incumbent:
    """The incumbent that is answered: with windows the baseline, where there is no opportunity."""
    return call.baseline if call.options.windowed and not helps(call) else call.best


def _status(call: Call, answer: Incumbent) -> Status:
    """The status by what is proved; an infinite bound is a proof."""
    if answer.key < INFINITE_KEY:
        return "optimal" if call.is_over and call.knows_alone and _is_best(call) else "feasible"
    is_proved = (call.is_over and call.is_done) or call.progress.bound >= INFINITE_KEY
    return "infeasible" if is_proved else "unknown"


def _is_best(call: Call) -> bool:
    """Whether nothing is better than the incumbent, as far as there is time to tell."""
    if call.is_done or call.is_known_best:
        return True
    with suppress(*LIMITS):
        return call.is_settled
    return False


def _outcome(call: Call) -> Answer:
    helped, keys = helps(call), call.keys
    answer = answered(call)
    status = _status(call, answer)
    has_plan = answer.key < INFINITE_KEY and status in ("optimal", "feasible")
    cost = keys.cost(answer.key) if has_plan else None
    baseline = keys.cost(call.baseline.key) if call.baseline.key < INFINITE_KEY else None
    saving_alone = None
    if baseline is not None and call.knows_alone and has_plan:
        saving_alone = baseline - keys.cost(call.idle.key)
    return Answer(
        status,
        human_plan=call.plan,
        horizon=call.horizon,
        reason=_reason(call, status),
        steps=steps_of(call, answer) if has_plan else None,
        window=Window(answer.node.start, answer.end) if answer.node and answer.end and has_plan else None,
        cost=cost,
        objective=keys.objective(answer.key) if has_plan else None,
        lower_bound=_lower_bound(call, status, answer),
        baseline=baseline,
        saving=saved(baseline, cost, opportunity=helped),
        saving_alone=saving_alone,
        opportunity=helped,
        expanded=call.progress.expanded,
        generated=call.progress.generated,
    )


def _reason(call: Call, status: Status) -> str | None:
    if status == "infeasible":
        return "no-plan" if call.epochs is None else "no-plan-within-horizon"
    return call.limit if status == "unknown" else None


def _lower_bound(call: Call, status: Status, answer: Incumbent) -> Fraction | None:
    """On the answer's objective; net of one epoch of window where it has none, or may lose it."""
    keys = call.keys
    if status == "optimal":
        return keys.objective(answer.key)
    if status == "infeasible":
        return None
    bound = keys.objective(min(max(call.progress.bound, call.floor), call.best.key))
    if call.options.windowed and (not answer.end or call.task.robot_goal or call.is_improvable):
        # The answer is the baseline, which has no K, or may become it: not every plan is an opportunity.
        bound = min(bound - call.options.window_weight, keys.objective(call.baseline.key))
    if answer.key < INFINITE_KEY:
        bound = min(bound, keys.objective(answer.key))
    return max(bound, Fraction(0))


def steps_of(call: Call, answer: Incumbent) -> tuple[Step, ...]:
    """What everybody does in a plan of the call."""
    if answer.node is None:
        return plan_steps(call.plan or ())
    if call.epochs is None and not call.context.packed.in_time:
        return schedule(call.task, path_sets(answer.node))
    steps = whole_plan(answer)
    walks = call.context.walks(call.plan or ()) if answer.node.idle else None
    return steps if walks is None else tuple(sorted((*steps, *walks.steps(answer.node))))
