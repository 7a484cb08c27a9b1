"""The strategies of a planning call, their turns in the order in which they come, and what each may take.

These tables are all there is of order and time.  A turn is taken where it applies, for its share of the
time that is left and its limit, and hands on what it has found.  Once nothing better is left, only those
are taken that come after the best plan.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from enum import Enum
from fractions import Fraction
from typing import Final, NamedTuple

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.packed.cost_vector import INFINITE_KEY, CostLayout
from search.strategies import conditions as calls
from search.strategies.call import Allowance, Call
from search.strategies.human_plan import first_bound, first_plan, known_plan, optimal_plan, plan_alone, saving
from search.strategies.joint_plans import joint_optimum, open_joint_optimum, team_optimum
from search.strategies.outcome import answer_of
from search.strategies.warm_start import WarmStart
from search.strategies.windows import all_plans, beside_timetable, robots_apart
from serendipity.model.answers.answer import Answer, Tried
from serendipity.model.errors import LIMITS, LimitReachedError, UsageError, limit_reason
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import HumanPlan


class CallStage(Enum):
    """The part of a call in which a turn is taken."""

    PREPARE = "as long as there may be a plan"
    IMPROVE = "as long as there may be a better one"
    FINISH = "once there is none"


class Turn(NamedTuple):
    """A row of the table: a strategy at work.

    Attributes:
        strategy: its name; what is chosen or left out is a strategy, or one turn of it.
        name: of the turn.
        applies: the condition under which a call takes it.
        run: takes it; yields whenever the incumbent has become better.
        share: of the time that is left.
        limit: of what it counts: nodes, or states; 0 where it counts nothing.
        stage: the part of the call that it belongs to.
    """

    strategy: str
    name: str
    applies: Callable[[Call], bool]
    run: Callable[[Call, Allowance], Iterable[None] | None]
    share: float = 1
    limit: int = 0
    stage: CallStage = CallStage.IMPROVE

    @property
    def does(self) -> str:
        """The first line of what its function says of itself."""
        return (self.run.__doc__ or "").partition("\n")[0]


STRATEGIES: Final = {
    "human-plan": "The human's optimal plan alone, and before it a greedy one to go on beside.",
    "warm-start": "The rest of the last answer, where it is a plan of this call.",
    "bound": "The private costs that are left to the human in every plan.",
    "joint-optimum": "The best plan of all agents together without a horizon, by the kernel's A*.",
    "robots-apart": "Windows of one epoch from what each robot can bring about by itself.",
    "timetable": "Windows of one epoch from all states beside the human's timetable.",
    "all-plans": "Best-first search over all windows and plans of the mode.",
}
"""The strategies, with what each does."""

_PREPARE, _FINISH = CallStage.PREPARE, CallStage.FINISH

TURNS: Final = (
    Turn("human-plan", "first-plan", calls.wants_first_plan, first_plan, stage=_PREPARE),
    Turn("human-plan", "optimal-plan-soon", calls.has_first_plan, optimal_plan, share=0.6, stage=_PREPARE),
    Turn("human-plan", "optimal-plan", calls.wants_human_plan, optimal_plan, stage=_PREPARE),
    Turn("warm-start", "warm-start", calls.is_warm, known_plan, share=0.3, stage=_PREPARE),
    Turn("human-plan", "alone", calls.has_given_plan, plan_alone, stage=_PREPARE),
    Turn("bound", "bound", calls.is_planned, first_bound, stage=_PREPARE),
    Turn("joint-optimum", "joint-optimum-soon", calls.joint_optimum_may_be_it, joint_optimum, share=0.4),
    Turn("all-plans", "few-nodes", calls.short_windows_suffice, all_plans, share=0.1, limit=100),
    Turn("timetable", "timetable-soon", calls.robots_only_leave_behind, beside_timetable, 0.1, 300_000),
    Turn("timetable", "timetable-on", calls.timetable_is_hopeful, beside_timetable, 0.35, 3_000_000),
    Turn("joint-optimum", "joint-bound", calls.joint_optimum_only_bounds, joint_optimum, 0.05, 100_000),
    Turn("robots-apart", "robots-apart", calls.robots_only_leave_behind, robots_apart, share=0.5),
    Turn("timetable", "timetable-last", calls.robots_only_leave_behind, beside_timetable, 0.9, 10_000_000),
    Turn("joint-optimum", "joint-optimum-on", calls.joint_optimum_is_open, open_joint_optimum, share=0.9),
    Turn("all-plans", "exact-bounds", calls.is_for_team_beside_plan, all_plans, limit=100),
    Turn("joint-optimum", "team", calls.is_for_kernel, team_optimum),
    Turn("all-plans", "all", calls.is_planned, all_plans),
    Turn("all-plans", "ties", calls.has_ties, all_plans, share=0.1, stage=_FINISH),
    Turn("human-plan", "saving", calls.compares_with_human, saving, stage=_FINISH),
)


def solve(
    prepared: PreparedTask,
    options: Options,
    *,
    human_plan: HumanPlan | None = None,
    predicts: bool = True,
    optimum: Fraction | None = None,
    deadline: Deadline | None = None,
    warm: WarmStart | None = None,
    turns: Sequence[Turn] = TURNS,
) -> Iterator[Answer]:
    """Answers with falling objective and rising lower bound; the last one is the best known.

    Args:
        options: options in force; ``mode`` is not ``assistance``.
        human_plan: ``pi_H``, already replayed, or None to predict it.
        predicts: False: without ``human_plan`` the human is known to have no plan alone.
        optimum: what a plan of the human's costs that is not to be improved on; None for what an optimal
            one costs.
        turns: those that may be taken; of these, those that the options name.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or one is missing; there is no such strategy.
    """
    chosen_ones = chosen(options.strategy_names, turns)
    try:
        context = SearchContext(prepared, options, deadline or Deadline(options.time_limit))
    except LIMITS as limit:
        yield Answer("unknown", reason=limit_reason(limit))
        return
    call = Call(context, human_plan, warm or WarmStart(), optimum)
    for _ in _improved(call, chosen_ones, predicts=predicts):
        yield answer_of(call)
    yield answer_of(call)


def best_plan(
    prepared: PreparedTask,
    options: Options,
    human_plan: HumanPlan,
    deadline: Deadline,
    turns: Sequence[Turn] = TURNS,
    most: Callable[[CostLayout], int] | None = None,
) -> Call | None:
    """A call at its end: its best plan counts, be it an opportunity or not; None where it could not begin.

    Args as for :func:`solve`, and:
        most: key that a plan has to beat, by the layout of keys; None: any plan will do.
    """
    try:
        call = Call(SearchContext(prepared, options, deadline), human_plan, WarmStart(), most=most)
    except LIMITS:
        return None
    for _ in _improved(call, chosen(options.strategy_names, turns), predicts=True):
        pass
    return call


def _improved(call: Call, turns: Sequence[Turn], *, predicts: bool) -> Iterator[None]:
    """Take the turns of a call; yield whenever more is known, but at the end."""
    try:
        begin(call, predicts=predicts)
        for turn in turns:
            if _is_due(call, turn.stage) and turn.applies(call):
                yield from _taken(call, turn)
        if not call.is_done and not call.is_settled:
            call.limit = "strategies"  # those that were chosen are not enough
    except LIMITS as limit:
        call.limit = limit_reason(limit)
        _go_on_beside_first_plan(call)
    call.is_over = True


def _is_due(call: Call, stage: CallStage) -> bool:
    if stage is CallStage.PREPARE:
        return call.refusal is None
    return (call.is_done or call.is_settled) == (stage is CallStage.FINISH)


def begin(call: Call, *, predicts: bool = True) -> None:
    """Go on beside a given plan, or without one where the answer does not have to wait for it."""
    if calls.is_for_team_first(call):
        call.begin_without_plan()
    elif call.given is not None and call.options.mode != "individual":
        call.follow(call.given, optimal=False)
    elif not predicts:
        call.follow(None, optimal=True)


def _taken(call: Call, turn: Turn) -> Iterator[None]:
    """Take a turn in its share of the time; yield whenever more is known, until the call's deadline."""
    deadline = call.context.deadline
    part = Allowance(deadline if turn.share == 1 else deadline.part(turn.share), turn.limit)
    begun, bound, known, better = deadline.elapsed(), call.progress.bound, call.best.key, 0
    try:
        for _ in turn.run(call, part) or ():
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
        call.tried.append(Tried(turn.name, seconds, better, risen, settled))


def chosen(names: Sequence[str], turns: Sequence[Turn] = TURNS) -> list[Turn]:
    """The turns that names choose: those named, or all but those with a minus sign.  Others are refused."""
    known = {turn.strategy for turn in turns} | {turn.name for turn in turns}
    for name in names:
        if name.removeprefix("-") not in known:
            few = ", ".join(dict.fromkeys(turn.strategy for turn in turns))
            raise UsageError(
                f"strategies: there is no '{name}'; expected some of {few}, a turn of one, or -NAME"
            )
    wanted = {name for name in names if not name.startswith("-")} or known
    unwanted = {name.removeprefix("-") for name in names if name.startswith("-")}
    return [t for t in turns if {t.strategy, t.name} & wanted and not {t.strategy, t.name} & unwanted]


def _go_on_beside_first_plan(call: Call) -> None:
    """Answer beside the best plan that was found, where a limit came before ``pi_H`` was known."""
    plan = None if call.first is None or not call.warm.steps else call.first.best
    if plan is not None and not call.is_planned and call.options.mode != "individual":
        with suppress(*LIMITS):
            call.follow(plan, optimal=False)
            known_plan(call, Allowance(call.context.deadline, 0))
