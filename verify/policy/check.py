"""From a result of mode ``assistance`` to claims."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from time import perf_counter

from serendipity.model import Claim, Deadline, PlanStep, Result, Task
from serendipity.model.answers.certificate import ClaimVerdict
from serendipity.model.numbers import agrees
from verify.base import wording
from verify.base.obligations import needed
from verify.base.undecided import UNDECIDED, during, why
from verify.policy.board import NOTHING, Board, Costs
from verify.policy.closed import BrokenError, Walk
from verify.policy.ending import lost_states
from verify.policy.figures import (
    answered,
    figure_faults,
    header_faults,
    least_sum,
    may_be_less,
    stated_bounds,
)
from verify.policy.floors import Floors
from verify.policy.reading import read_decisions, show


def check_run(task: Task, board: Board, result: Result) -> None:
    """Return if the plan is a run in which the human acts optimally, or raise a BrokenError."""
    assert result.plan is not None
    human = result.human
    for step in result.plan:
        _check_step(task, step)
    done = {(step.epoch, step.agents == (human,)): step.action for step in result.plan}
    if len(done) < len(result.plan):
        raise BrokenError("replay", "plan: an agent acts twice in one epoch")
    state, totals = board.start, [Fraction(0), Fraction(0)]
    for epoch in range(1, max((step.epoch for step in result.plan), default=0) + 1):
        name = done.get((epoch, False), "noop")
        cost, state = _done(board.moves(state), name, "the supporter can't", epoch)
        totals[1] += cost
        if not board.goal.holds(state):
            cost, state = _done(board.replies(state), done.get((epoch, True)), "the human would not", epoch)
            totals[0] += cost
        elif (epoch, True) in done:
            raise BrokenError("replay", f"plan, epoch {epoch}: the goal holds before '{done[epoch, True]}'")
    if not board.goal.holds(state):
        raise BrokenError("replay", "plan: the goal does not hold after the last epoch")
    if not all(map(agrees, result.agent_costs.values(), totals)):
        raise BrokenError("cost", f"plan: costs {totals[0]} and {totals[1]}, not what agent_costs says")


def _done(
    possible: Iterable[tuple[Fraction, int, str | None]], name: str | None, fault: str, epoch: int
) -> tuple[Fraction, int]:
    """What an action costs, and the state after it."""
    found = next(((cost, after) for cost, after, action in possible if action == name), None)
    if found is None:
        what = "wait" if name is None else f"do '{name}'"
        raise BrokenError("replay", f"plan, epoch {epoch}: {fault} {what}")
    return found


def _check_step(task: Task, step: PlanStep) -> None:
    """Return if a step has an agent and a cost that an action of its name has."""
    actions = [task.actions[i] for i in task.named.get(step.action, ())]
    agents = [tuple(task.agents[i] for i in action.participants) for action in actions]
    if step.agents not in agents:
        raise BrokenError("replay", f"plan, epoch {step.epoch}: there is no '{step.action}' of these agents")
    if not any(agrees(step.cost, action.cost) for action in actions):
        raise BrokenError("cost", f"plan, epoch {step.epoch}: '{step.action}' does not cost {step.cost:g}")


def check_policy(
    task: Task, result: Result, deadline: Deadline, *, replay_only: bool = False
) -> tuple[Claim, ...]:
    """Claims about a policy: ``replay``, ``cost``, ``optimal``, ``lower_bound`` or ``infeasible``.

    Args:
        task: one human, one robot.
        replay_only: leave out what needs more than a walk through the policy's own states.
    """
    checker = _Checker(task, result, deadline, replay_only=replay_only)
    claims = []
    started = perf_counter()
    for claim in checker.claims():
        now = perf_counter()
        claims.append(replace(claim, seconds=now - started))
        started = now
    return tuple(claims)


class _Checker:
    def __init__(self, task: Task, result: Result, deadline: Deadline, *, replay_only: bool) -> None:
        self._result = result
        self._replay_only = replay_only
        self._task = task
        self._deadline = deadline

    def claims(self) -> Iterator[Claim]:
        result = self._result
        if len(self._task.robots) != 1:
            yield Claim("replay", "refuted", wording.ONE_ROBOT)
            return
        fault = next(header_faults(result), None)
        if fault is not None:
            yield Claim(fault[0], "refuted", fault[1])
            return
        try:
            with during("setting up the game"):
                board = Board(self._task, result.options, self._deadline)
        except UNDECIDED as error:
            yield from self._undecided(why(error))
            return
        if result.status == "infeasible":
            doing = "looking at every state of the game"
            yield self._examined("infeasible", doing, lambda: self._infeasible(board))
        elif result.policy is not None:
            yield from self._with_policy(board)
        elif result.lower_bound is not None:
            yield self._bounded(board)
        else:
            yield Claim("replay", "not_in_scope", wording.NOTHING_TO_EXAMINE)

    def _examined(self, name: str, doing: str, examine: Callable[[], tuple[ClaimVerdict, str]]) -> Claim:
        """A claim that takes more than a walk through the policy's own states."""
        if self._replay_only:
            return Claim(name, "not_in_scope", wording.NEEDS_MORE_THAN_A_WALK)
        try:
            with during(doing):
                return Claim(name, *examine())
        except UNDECIDED as error:
            return Claim(name, "undecided", why(error))

    def _undecided(self, reason: str) -> Iterator[Claim]:
        """Every claim that a proof needs."""
        return (Claim(name, "undecided", reason) for name in needed(self._result))

    def _infeasible(self, board: Board) -> tuple[ClaimVerdict, str]:
        if board.goal.holds(board.start) or board.start not in lost_states(board):
            return "refuted", wording.POLICY_ENDS
        return "proved", wording.RUNS_FOR_EVER

    def _with_policy(self, board: Board) -> Iterator[Claim]:
        assert self._result.policy is not None
        try:
            with during("walking through the policy"):
                listed = read_decisions(board, self._result.policy)
                value = Walk(board, listed).value()
                if self._result.plan is not None:
                    check_run(self._task, board, self._result)
                value = answered(self._result, value)
                fault = next(figure_faults(self._task, board, self._result, value), None)
        except ValueError as error:
            yield Claim("replay", "refuted", str(error))
            return
        except BrokenError as broken:
            yield Claim(broken.claim, "refuted", str(broken))
            return
        except UNDECIDED as error:
            yield from self._undecided(why(error))
            return
        if fault is not None:
            yield Claim(fault[0], "refuted", fault[1])
            return
        yield Claim("replay", "proved", wording.FOLLOWED_BY_POLICY)
        worth = wording.POLICY_AT_MOST if may_be_less(self._result) else wording.POLICY_VALUES
        yield Claim("cost", "proved", worth.format(show(value)))
        if self._result.status == "optimal":
            proving = "proving the lower bounds"
            best = self._examined("optimal", proving, lambda: self._optimal(board, value))
            yield best
            yield replace(best, claim="lower_bound", reason=wording.same_as(best))
        else:
            yield self._bounded(board)

    def _bounded(self, board: Board) -> Claim:
        """A bound that comes without a proof: whether both together, without turns, pay as much."""
        bounds = stated_bounds(self._result)

        def examine() -> tuple[ClaimVerdict, str]:
            if not agrees(self._result.lower_bound, least_sum(bounds)):
                return "refuted", wording.BOUND_EXPECTED.format(float(least_sum(bounds)))
            trivial = bounds.lower == NOTHING or board.goal.holds(board.start)
            if trivial or board.at_least(board.start, bounds.lower):
                return "proved", wording.TOGETHER_PAY.format(show(bounds.lower))
            return "undecided", wording.TOGETHER_MIGHT

        return self._examined("lower_bound", "adding up what both pay", examine)

    def _optimal(self, board: Board, value: Costs) -> tuple[ClaimVerdict, str]:
        assert self._result.policy is not None
        try:
            Floors(board, self._result.policy).prove(value)
        except KeyError as error:
            return "undecided", f"the task has no fact {error}"
        return "proved", wording.FLOORS_REACH
