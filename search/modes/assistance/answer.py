"""From a task and options to the answer of mode ``assistance`` (semantics 7)."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import Final

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.modes.assistance.bounds.bound import joint_lower_bound
from search.modes.assistance.game.game import Game
from search.modes.assistance.game.rules import ChoiceRule, Mean
from search.modes.assistance.game.solution import ZERO, GameSolution
from search.modes.assistance.solvers.lao_star import LaoStar
from search.modes.assistance.writing import Writer
from search.packed.cost_vector import INFINITE_KEY
from search.strategies.first_answer import first_answer
from serendipity.model.answers.answer import Answer, PolicyBounds, Status
from serendipity.model.answers.policy import Costs, Policy
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task

_PLAN_SHARE: Final = 0.3
"""What of the time some plan of the prime's may take."""

_OWN_SHARE: Final = 0.5
"""What of the time the prime's own optimum may take before anything is searched."""

_BOUND_SHARE: Final = 0.04
"""What a first bound may add to the time limit: a share of it."""


def assist(prepared: PreparedTask, options: Options, deadline: Deadline) -> Iterator[Answer]:
    """Answers of falling value; the last one is the best known.

    Args:
        prepared: a task of one human and exactly one robot.
        options: ``ties`` and ``no_block`` count.
    """
    own_deadline = deadline.part(_OWN_SHARE)
    try:
        game = Game(prepared, deadline, own_deadline)
    except LIMITS as limit:
        yield _bounded(prepared.task, "unknown", reason=limit_reason(limit))
        return
    most = _most_alone(game)
    if most < INFINITE_KEY:
        yield _bounded(game.task, "feasible", upper=game.pair(most))
    late = None
    try:
        game.alone(game.init)
    except LIMITS as limit:
        late = limit_reason(limit)
    if late is not None:  # what the work held is free by now
        yield _without_his_optimum(game, most, late)
        return
    own_deadline.renew(deadline)
    yield from _searched(game, options)


def _most_alone(game: Game) -> int:
    """An upper bound on doing nothing, by some plan of the prime's at hand; else ``INFINITE_KEY``."""
    try:
        plan = first_answer(game.prepared, Options(), game.deadline.part(_PLAN_SHARE)).plan
    except LIMITS:
        return INFINITE_KEY
    return INFINITE_KEY if plan is None else game.value_alone(plan)


def _searched(game: Game, options: Options) -> Iterator[Answer]:
    """Answers of the search, which needs to know what the prime does alone."""
    rule = (Mean if options.ties == "expected" else ChoiceRule)(game, options.ties)
    writer = Writer(game, rule)
    search: LaoStar | None = None
    try:
        search = LaoStar(game, rule, no_block=bool(options.no_block))
        for _ in search.run():
            yield _answer(writer, search.solution(floors=False), "feasible", search.expanded)
        solution = search.solution()
        status: Status = "infeasible" if solution.upper is None else "optimal"
        yield _answer(writer, solution, status, search.expanded)
        return
    except LIMITS as limit:
        late = limit_reason(limit)
    yield _unfinished(game, writer, search, late)


def _without_his_optimum(game: Game, upper: int, limit: str) -> Answer:
    """Bounds where the prime's optimal cost could not be worked out in half of the time, or in memory."""
    if limit == "memory-limit":
        game.forget_own()
    lower = _bound_without_search(game, game.deadline)
    if lower is None:
        return _bounded(game.task, "infeasible", reason="no-plan")
    if upper >= INFINITE_KEY:
        with suppress(*LIMITS):
            plan = SearchContext(game.prepared, Options(), game.deadline).alone.first_plan(game.init)
            upper = INFINITE_KEY if plan is None else game.value_alone(plan)
    if upper >= INFINITE_KEY:
        return _bounded(game.task, "unknown", lower, reason=limit)
    return _bounded(game.task, "feasible", lower, game.pair(upper))


def _unfinished(game: Game, writer: Writer, search: LaoStar | None, limit: str) -> Answer:
    """The answer when the time is up: doing nothing is always one, if the prime has a plan."""
    known, expanded = GameSolution(None, None), 0
    if search is not None:
        known, expanded = search.solution(floors=False), search.expanded
        if known.upper is not None and known.lower == known.upper:
            return _answer(writer, search.solution(), "optimal", expanded)
    least = _bound_without_search(game, game.deadline.sooner(-_BOUND_SHARE))
    if least is None:
        return _bounded(game.task, "infeasible", reason="no-plan")
    lower = max(least, known.lower or ZERO)
    status: Status = "optimal" if lower == known.upper else "feasible"
    if known.upper is None:
        alone = game.alone(game.init)  # known since the first phase
        if alone >= INFINITE_KEY:
            return _bounded(game.task, "unknown", lower, reason=limit)
        known = GameSolution(None, game.pair(alone))
    return _answer(writer, replace(known, lower=lower), status, expanded)


def _bound_without_search(game: Game, deadline: Deadline) -> Costs | None:
    """A lower bound from the initial state alone, 0 where there is no time even for that; None: no plan."""
    try:
        value = joint_lower_bound(game, deadline)
    except LIMITS:
        return ZERO
    return None if value >= INFINITE_KEY else game.pair(value)


def _bounded(
    task: Task, status: Status, lower: Costs = ZERO, upper: Costs | None = None, reason: str | None = None
) -> Answer:
    """Bounds are all that is known; with one on what it is worth at most, doing nothing is the policy."""
    bounds, policy = PolicyBounds(lower, upper), None if upper is None else Policy((), None)
    return _with_figures(task, Answer(status, reason=reason, bounds=bounds, policy=policy))


def _answer(writer: Writer, solution: GameSolution, status: Status, expanded: int) -> Answer:
    has_policy = status != "infeasible"
    plan = steps = None
    with suppress(*LIMITS):  # the time may be up before it is known what the prime chooses
        plan = writer.human_plan()
    policy = writer.policy(solution) if has_policy else None
    with suppress(*LIMITS):
        steps = writer.plan(solution) if has_policy else None
    answer = Answer(
        status,
        human_plan=plan,
        policy=policy,
        steps=steps,
        reason=None if has_policy else "no-plan",
        expanded=expanded,
        bounds=PolicyBounds(solution.lower or ZERO, solution.upper),
    )
    return _with_figures(writer.task, answer)


def _with_figures(task: Task, answer: Answer) -> Answer:
    """An answer with the figures that follow from its bounds and from the human's plan alone."""
    bounds, plan = answer.bounds, answer.human_plan
    assert bounds is not None, "a policy has them"
    baseline = None if plan is None else task.cost_of(plan)
    total = None if bounds.upper is None else sum(bounds.upper, Fraction(0))
    saving = None if baseline is None or bounds.upper is None else baseline - bounds.upper[0]
    return answer._replace(
        cost=total,
        objective=total,
        lower_bound=None if answer.status == "infeasible" else _least_sum(bounds),
        baseline=baseline,
        saving=saving,
        saving_alone=None if baseline is None else Fraction(0),
        opportunity=saving is not None and saving > 0,
        generated=None,
        realised={},
    )


def _least_sum(bounds: PolicyBounds) -> Fraction:
    """A lower bound on the sum of both costs, the human's coming first."""
    lower, upper = bounds.lower, bounds.upper
    return sum(lower, Fraction(0)) if upper is not None and lower[0] == upper[0] else lower[0]
