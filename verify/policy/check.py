"""From a result of mode ``assistance`` to claims."""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from time import perf_counter
from typing import Final

from serendipity.model import Claim, Deadline, Result, Task
from verify.policy.board import Board, Costs
from verify.policy.closed import BrokenError, Walk
from verify.policy.ending import ends
from verify.policy.floors import Floors
from verify.policy.reading import read_decisions, show
from verify.policy.run import check_run
from verify.undecided import UNDECIDED, why

_NO_WALK: Final = "not examined: it takes more than a walk through the policy; verify looks at it"


def check_policy(
    task: Task, result: Result, deadline: Deadline, *, replay_only: bool = False
) -> tuple[Claim, ...]:
    """Claims about a policy: ``replay``, ``cost``, ``optimal`` or ``infeasible``.

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
            yield Claim("replay", "refuted", "mode 'assistance' is for one robot")
            return
        board = Board(self._task, fixed=self._ties == "fixed", deadline=self._deadline)
        if result.status == "infeasible":
            yield (
                Claim("infeasible", "not_in_scope", _NO_WALK)
                if self._replay_only
                else self._infeasible(board)
            )
        elif result.policy is not None:
            yield from self._with_policy(board)

    def _infeasible(self, board: Board) -> Claim:
        try:
            if ends(board, self._ties, no_block=self._no_block, deadline=self._deadline):
                return Claim("infeasible", "refuted", "there is a policy that ends")
        except UNDECIDED as error:
            return Claim("infeasible", "undecided", why(error))
        return Claim("infeasible", "proved", "whatever the supporter does, a run may go on for ever")

    def _with_policy(self, board: Board) -> Iterator[Claim]:
        assert self._result.policy is not None
        try:
            listed = read_decisions(board, self._result.policy)
            value = Walk(board, listed, self._ties, no_block=self._no_block).value()
            if self._result.plan is not None and self._result.status == "optimal":
                check_run(board, self._result)
        except ValueError as error:
            yield Claim("replay", "refuted", str(error))
            return
        except BrokenError as broken:
            yield Claim(broken.claim, "refuted", str(broken))
            return
        except UNDECIDED as error:
            yield Claim("replay", "undecided", why(error))
            return
        yield Claim("replay", "proved", "closed under what the human may do, and every run ends")
        yield self._cost(value)
        if self._result.status == "optimal":
            yield (
                Claim("optimal", "not_in_scope", _NO_WALK)
                if self._replay_only
                else self._optimal(board, value)
            )

    def _cost(self, value: Costs) -> Claim:
        result = self._result
        given = [Fraction(str(cost)) for cost in result.agent_costs.values()]
        totals = [Fraction(str(float(cost))) for cost in value]
        names = [self._task.agents[self._task.human], self._task.agents[self._task.robots[0]]]
        if list(result.agent_costs) != names or given != totals:
            expected = ", ".join(f"{name} {float(cost):g}" for name, cost in zip(names, value, strict=True))
            return Claim("cost", "refuted", f"agent_costs: expected {expected}, got {result.agent_costs}")
        if result.cost != float(sum(value)):
            return Claim("cost", "refuted", f"cost: expected {float(sum(value)):g}, got {result.cost}")
        return Claim(
            "cost", "proved", f"each value is what a round and the values after it make: {show(value)}"
        )

    def _optimal(self, board: Board, value: Costs) -> Claim:
        assert self._result.policy is not None
        try:
            floors = Floors(
                board, self._result.policy, self._ties, no_block=self._no_block, deadline=self._deadline
            )
            floors.prove(value)
        except KeyError as error:
            return Claim("optimal", "undecided", f"the task has no fact {error}")
        except UNDECIDED as error:
            return Claim("optimal", "undecided", why(error))
        return Claim("optimal", "proved", "lower bounds that prove each other reach the policy's value")
