"""Composite plans: where goals are shared they bound the answer in every mode, and one of them may be it."""

from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from search.engine.best_first import Incumbent
from search.packed.cost_vector import INFINITE_KEY
from search.packed.parallelise import schedule
from search.spaces.from_composite import Suggestions
from search.strategies.call import Allowance, Call
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.plans import Step

if TYPE_CHECKING:  # loaded by the calls that it serves
    from search.classical.team import Sets, Team

_SUGGESTIONS: Final = 0.05
"""The share of the time that is left for what one composite plan suggests in a mode with other rules."""

_OWN_LIMIT: Final = "strategies"
"""The reason of a limit that is the strategy's own: others go on."""


def team_optimum(call: Call, part: Allowance) -> Iterator[None]:
    """The best composite plan of any length, which is the answer."""
    team, context = _team(call), call.context
    before = call.progress.expanded, call.progress.generated
    init = context.packed.init
    try:
        for sets in team.better_plans(
            init, part.deadline, lambda amount: call.raise_bound(context.weights.key_of(amount))
        ):
            _count(call, team, before)
            node = context.played([context.packed.op(action) for action in actions] for actions in sets)
            if call.offer(Incumbent(node.key, node)):
                yield
    finally:
        _count(call, team, before)
    call.finish()


def _count(call: Call, team: "Team", before: tuple[int, int]) -> None:
    expanded, generated, _ = team.planner.counts()
    call.progress.expanded, call.progress.generated = before[0] + expanded, before[1] + generated


def _team(call: Call) -> "Team":
    team = call.context.team
    assert team is not None, "the kernel can tell"
    return team


def joint_optimum(call: Call, part: Allowance) -> Iterator[None]:
    """The joint optimum without a horizon, as far as it goes: a bound, and what it suggests."""
    team, init = _team(call), call.context.packed.init

    def raise_bound(amount: int) -> None:
        _raise(call, amount)
        if part.limit and team.planner.counts()[2] > part.limit:
            raise LimitReachedError(_OWN_LIMIT)

    try:
        yield from _take_all(call, team.better_plans(init, part.deadline, raise_bound))
    except LimitReachedError as limit:
        if limit.reason != _OWN_LIMIT:
            raise


def open_joint_optimum(call: Call, part: Allowance) -> Iterator[None]:
    """The joint optimum without a horizon, from where a limit came."""
    plans = _team(call).go_on(call.context.packed.init, part.deadline, partial(_raise, call))
    yield from _take_all(call, plans)


def _take_all(call: Call, plans: "Iterable[Sets]") -> Iterator[None]:
    """Offer what plans of the team suggest; the last of them costs least."""
    for sets in plans:
        call.has_joint_plan = True
        if not call.context.packed.in_time and _suggest(call, schedule(call.task, sets)):
            yield
    _raise(call, _team(call).planner.least if call.has_joint_plan else INFINITE_KEY)


def _raise(call: Call, amount: int) -> None:
    """Note that no composite plan costs the team less than an amount."""
    call.raise_joint_bound(call.context.weights.key_of(amount))


def _suggest(call: Call, steps: Sequence[Step]) -> bool:
    """Whether something that a composite plan suggests is the best so far in this mode."""
    context, options = call.context, call.options
    in_order = options.preservation == "kernel" and not options.keep_prefix
    if call.epochs is None or context.weights.announces or not in_order:
        return False
    part = context.under(context.deadline.part(_SUGGESTIONS))
    suggestions = Suggestions(part, call.plan or (), call.epochs, call.most_cost, call.best.key)
    is_better = False
    try:
        for found in suggestions.of(steps):
            is_better = call.offer(found) or is_better
    except LimitReachedError:
        context.deadline.check()
    return is_better
