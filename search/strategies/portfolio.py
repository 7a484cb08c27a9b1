"""The strategies of a planning call, in the order in which they are tried, and what each may take.

This table is all there is of order and time.  A strategy is tried where it applies, for its share of the
time that is left and its limit, and hands on what it has found.  Once nothing better is left, only those
are tried that come after the best plan.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from enum import Enum
from typing import Final, NamedTuple

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.packed.cost_vector import INFINITE_KEY
from search.strategies import conditions as calls
from search.strategies.call import Call, Part
from search.strategies.human_plan import first_bound, first_plan, known_plan, optimal_plan, plan_alone, saving
from search.strategies.joint_plans import (
    along_human_plan,
    greedily_within_horizon,
    joint_optimum,
    open_joint_optimum,
    team_optimum,
    within_horizon,
)
from search.strategies.outcome import answer_of
from search.strategies.short_windows import beside_timetable, robots_apart, robots_by_numbers
from search.strategies.warm_start import WarmStart
from search.strategies.windows import all_plans, few_nodes, one_epoch, ties, while_bounds_are_exact
from serendipity.model.answers.answer import Answer, Tried
from serendipity.model.errors import LIMITS, LimitReachedError, UsageError, limit_reason
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import HumanPlan


class Stage(Enum):
    """When a strategy is tried."""

    PREPARE = "as long as there may be a plan"
    IMPROVE = "as long as there may be a better one"
    FINISH = "once there is none"


class Strategy(NamedTuple):
    """A row of the table.

    Attributes:
        name: for those who choose.
        applies: whether it is tried in a call, as that stands.
        run: tries it; yields whenever the incumbent has become better.
        share: of the time that is left.
        limit: of what it counts: nodes, states, or what its bound counts for; 0 where it counts nothing.
        stage: when it is tried.
    """

    name: str
    applies: Callable[[Call], bool]
    run: Callable[[Call, Part], Iterable[None] | None]
    share: float = 1
    limit: int = 0
    stage: Stage = Stage.IMPROVE

    @property
    def does(self) -> str:
        """What it tries, in a line."""
        return (self.run.__doc__ or "").partition("\n")[0]


STRATEGIES: Final = (
    Strategy("first-plan", calls.wants_first_plan, first_plan, stage=Stage.PREPARE),
    Strategy("human-plan-soon", calls.has_first_plan, optimal_plan, share=0.6, stage=Stage.PREPARE),
    Strategy("human-plan", calls.wants_human_plan, optimal_plan, stage=Stage.PREPARE),
    Strategy("known", calls.is_warm, known_plan, share=0.3, stage=Stage.PREPARE),
    Strategy("alone", calls.has_given_plan, plan_alone, stage=Stage.PREPARE),
    Strategy("bound", calls.is_planned, first_bound, stage=Stage.PREPARE),
    Strategy("joint-optimum", calls.joint_optimum_may_be_it, joint_optimum, share=0.4),
    Strategy("joint-bound", calls.joint_optimum_only_bounds, joint_optimum, share=0.05),
    Strategy("few-nodes", calls.short_windows_suffice, few_nodes, share=0.1, limit=500),
    Strategy("robots-by-numbers", calls.robots_only_leave_behind, robots_by_numbers, share=0.7),
    Strategy("timetable-soon", calls.robots_only_leave_behind, beside_timetable, share=0.1, limit=300_000),
    Strategy("timetable-on", calls.timetable_is_hopeful, beside_timetable, share=0.35, limit=3_000_000),
    Strategy("robots-apart", calls.robots_only_leave_behind, robots_apart, share=0.5),
    Strategy("timetable", calls.robots_only_leave_behind, beside_timetable, share=0.9, limit=10_000_000),
    Strategy("along-plan", calls.may_begin_at_once, along_human_plan, share=0.1),
    Strategy("one-epoch", calls.longer_windows_may_pay, one_epoch, share=0.1),
    Strategy("greedy", calls.joint_plans_on_the_way, greedily_within_horizon, share=0.2, limit=5),
    Strategy("joint-optimum-on", calls.joint_optimum_is_open, open_joint_optimum, share=0.9),
    Strategy("within-horizon", calls.joint_plans_decide_here, within_horizon),
    Strategy("exact-bounds", calls.is_for_team_beside_plan, while_bounds_are_exact),
    Strategy("team", calls.is_for_kernel, team_optimum),
    Strategy("all", calls.is_planned, all_plans),
    Strategy("ties", calls.has_ties, ties, share=0.1, stage=Stage.FINISH),
    Strategy("saving", calls.compares_with_human, saving, stage=Stage.FINISH),
)


def solve(
    prepared: PreparedTask,
    options: Options,
    *,
    human_plan: HumanPlan | None = None,
    deadline: Deadline | None = None,
    warm: WarmStart | None = None,
    strategies: Sequence[Strategy] = STRATEGIES,
) -> Iterator[Answer]:
    """Answers with falling objective and rising lower bound; the last one is the best known.

    Args:
        prepared: the task.
        options: options in force; ``mode`` is not ``assistance``.
        human_plan: ``pi_H``, already replayed, or None to predict it.
        deadline: deadline and cancellation.
        warm: what is known before.
        strategies: what is tried; of these, those that the options name.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or one is missing; there is no such strategy.
    """
    chosen_ones = chosen(options.strategy_names, strategies)
    try:
        context = SearchContext(prepared, options, deadline or Deadline(options.time_limit))
    except LIMITS as limit:
        yield Answer("unknown", reason=limit_reason(limit))
        return
    call = Call(context, human_plan, warm or WarmStart())
    try:
        begin(call)
        for strategy in chosen_ones:
            if _is_due(call, strategy.stage) and strategy.applies(call):
                for _ in _tried(call, strategy):
                    yield answer_of(call)
        if not call.is_done and not call.is_settled:
            call.limit = "strategies"  # those that were chosen are not enough
    except LIMITS as limit:
        call.limit = limit_reason(limit)
        _go_on_beside_first_plan(call)
    call.is_over = True
    yield answer_of(call)


def _is_due(call: Call, stage: Stage) -> bool:
    if stage is Stage.PREPARE:
        return call.refusal is None
    return (call.is_done or call.is_settled) == (stage is Stage.FINISH)


def begin(call: Call) -> None:
    """Go on beside a given plan, or without one where the answer does not have to wait for it."""
    if calls.is_for_team_first(call):
        call.begin_without_plan()
    elif call.given is not None and call.options.mode != "individual":
        call.follow(call.given, optimal=False)


def _tried(call: Call, strategy: Strategy) -> Iterator[None]:
    """Try a strategy in its share of the time; yield whenever more is known.

    Raises:
        LimitReachedError: the deadline of the call came.
    """
    deadline = call.context.deadline
    part = Part(deadline if strategy.share == 1 else deadline.part(strategy.share), strategy.limit)
    begun, bound, known, better = deadline.elapsed(), call.progress.bound, call.best.key, 0
    try:
        for _ in strategy.run(call, part) or ():
            better += call.best.key < known
            known = call.best.key
            yield
    except LimitReachedError:
        if part.deadline is deadline:
            raise
        deadline.check()
    finally:
        least = call.progress.bound
        risen = call.keys.objective(least) if bound < least < INFINITE_KEY else None
        seconds, settled = deadline.elapsed() - begun, call.is_done or call.is_settled
        call.tried.append(Tried(strategy.name, seconds, better, risen, settled))


def chosen(names: Sequence[str], strategies: Sequence[Strategy] = STRATEGIES) -> list[Strategy]:
    """The strategies that some names choose: those named, or all but those with a minus sign.

    Raises:
        UsageError: there is no strategy of a name.
    """
    every = [strategy.name for strategy in strategies]
    for name in names:
        if name.removeprefix("-") not in every:
            raise UsageError(
                f"strategies: there is no '{name}'; expected some of {', '.join(every)}, or -NAME"
            )
    wanted = {name for name in names if not name.startswith("-")} or {*every}
    return [s for s in strategies if s.name in wanted and f"-{s.name}" not in names]


def _go_on_beside_first_plan(call: Call) -> None:
    """Answer beside the best plan that was found, where a limit came before ``pi_H`` was known."""
    plan = None if call.first is None or not call.warm.steps else call.first.best
    if plan is not None and not call.is_planned and call.options.mode != "individual":
        with suppress(*LIMITS):
            call.follow(plan, optimal=False)
            known_plan(call, Part(call.context.deadline, 0))
