"""From a result of mode ``assistance`` to claims."""

from collections.abc import Iterator
from dataclasses import replace
from time import perf_counter

from serendipity.model import Claim, Deadline, Result, Task
from serendipity.model.numbers import agrees
from verify.base import wording
from verify.base.obligations import needed
from verify.base.undecided import UNDECIDED, during, why
from verify.policy.board import NOTHING, Board, Costs
from verify.policy.closed import BrokenError, Walk
from verify.policy.ending import ends
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
from verify.policy.run import check_run


def check_policy(
    task: Task, result: Result, deadline: Deadline, *, replay_only: bool = False
) -> tuple[Claim, ...]:
    """Claims about a policy: ``replay``, ``cost``, ``optimal``, ``lower_bound`` or ``infeasible``.

    Args:
        task: one human, one robot.
        result: an answer of mode ``assistance``.
        deadline: after which claims stay undecided.
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
        self._ties = result.options.ties
        self._no_block = bool(result.options.no_block)
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
                board = Board(self._task, fixed=self._ties == "fixed", deadline=self._deadline)
        except UNDECIDED as error:
            yield from self._undecided(why(error))
            return
        if result.status == "infeasible":
            yield self._unless_replay_only("infeasible") or self._infeasible(board)
        elif result.policy is not None:
            yield from self._with_policy(board)
        elif result.lower_bound is not None:
            yield self._unless_replay_only("lower_bound") or self._bounded(board)
        else:
            yield Claim("replay", "not_in_scope", wording.NOTHING_TO_EXAMINE)

    def _unless_replay_only(self, name: str) -> Claim | None:
        return Claim(name, "not_in_scope", wording.NEEDS_MORE_THAN_A_WALK) if self._replay_only else None

    def _undecided(self, reason: str) -> Iterator[Claim]:
        """Every claim that a proof needs."""
        return (Claim(name, "undecided", reason) for name in needed(self._result))

    def _infeasible(self, board: Board) -> Claim:
        try:
            with during("looking at every state of the game"):
                end = ends(board, self._ties, no_block=self._no_block, deadline=self._deadline)
        except UNDECIDED as error:
            return Claim("infeasible", "undecided", why(error))
        if end:
            return Claim("infeasible", "refuted", wording.POLICY_ENDS)
        return Claim("infeasible", "proved", wording.RUNS_FOR_EVER)

    def _with_policy(self, board: Board) -> Iterator[Claim]:
        assert self._result.policy is not None
        try:
            with during("walking through the policy"):
                listed = read_decisions(board, self._result.policy)
                value = Walk(board, listed, self._ties, no_block=self._no_block).value()
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
            best = self._unless_replay_only("optimal") or self._optimal(board, value)
            yield best
            yield replace(best, claim="lower_bound", reason=wording.same_as(best))
        else:
            yield self._unless_replay_only("lower_bound") or self._bounded(board)

    def _bounded(self, board: Board) -> Claim:
        """A bound that comes without a proof: whether both together, without turns, pay as much."""
        try:
            bounds = stated_bounds(self._result)
            if not agrees(self._result.lower_bound, least_sum(bounds)):
                return Claim(
                    "lower_bound", "refuted", wording.BOUND_EXPECTED.format(float(least_sum(bounds)))
                )
            if (
                bounds.lower == NOTHING
                or board.goal.holds(board.start)
                or board.at_least(board.start, bounds.lower)
            ):
                return Claim("lower_bound", "proved", wording.TOGETHER_PAY.format(show(bounds.lower)))
        except UNDECIDED as error:
            return Claim("lower_bound", "undecided", why(error))
        return Claim("lower_bound", "undecided", wording.TOGETHER_MIGHT)

    def _optimal(self, board: Board, value: Costs) -> Claim:
        assert self._result.policy is not None
        try:
            with during("proving the lower bounds"):
                floors = Floors(
                    board, self._result.policy, self._ties, no_block=self._no_block, deadline=self._deadline
                )
                floors.prove(value)
        except KeyError as error:
            return Claim("optimal", "undecided", f"the task has no fact {error}")
        except UNDECIDED as error:
            return Claim("optimal", "undecided", why(error))
        return Claim("optimal", "proved", wording.FLOORS_REACH)
