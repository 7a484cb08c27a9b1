"""The human alone, without a horizon, as a program: one unit of flow through the states that they reach."""

from collections.abc import Hashable, Sequence
from fractions import Fraction
from typing import Any, Final

from serendipity.model import Options, Task
from verify.base.beside_script import alone_of
from verify.base.individual import IndividualOptimum
from verify.base.small_numbers import OrderOfSums
from verify.base.subproblem import prices
from verify.base.undecided import HumanTooLargeError, UndecidedError, during
from verify.limits import limits
from verify.programs.effort import Attempt, Effort
from verify.programs.recorded import described, refute
from verify.proofs.book import Entry, ProofReader, require_same
from verify.solvers.mip import BYTES_A_TERM, Model

_BYTES_A_MOVE: Final = 350 + 3 * BYTES_A_TERM


def cost_alone(task: Task, options: Options, effort: Effort, alone: IndividualOptimum) -> Fraction | None:
    """The human's least cost alone, by a program or by a search over states, as the method says; or None."""
    if effort.method == "program":
        return least_alone(task, options, effort)
    worth = alone.predicted()
    return None if worth is None else worth[0]


def least_alone(task: Task, options: Options, effort: Effort) -> Fraction | None:
    """The least cost of a plan of the human's own, by a program; None: there is no plan.

    Args:
        options: the call's; they decide on units only.
        effort: the solver's settings; where it reads a proof, that answers instead of the solver.

    Raises:
        UndecidedError: neither was proved, or the proof is of something else.
    """
    effort.attempts.append(Attempt("programs", decided=True))
    with during("writing a program for what the human can do alone"):
        program = _AloneProgram(task, options, effort)
    units = program.read(effort.proof) if isinstance(effort.proof, ProofReader) else program.solve()
    return None if units is None else Fraction(units, program.scale) + program.alone.paid_before


class _AloneProgram:
    """Columns are moves between states; a cycle adds cost, so the best flow is a path."""

    def __init__(self, task: Task, options: Options, effort: Effort) -> None:
        self._effort = effort
        self._deadline = effort.deadline
        self.scale = prices(task, options, (), self._deadline).scale
        self.alone = alone_of(task, self._deadline, options)
        self._number: dict[Hashable, int] = {}
        self._order = OrderOfSums()
        self.model = Model(self._deadline)
        self._write()

    def _write(self) -> None:
        moves = self._moves()
        self._deadline.require(len(moves) * _BYTES_A_MOVE)
        rows: list[dict[int, int]] = [{} for _ in self._number]
        arrivals: dict[int, int] = {}
        ends = set(self._ends)
        # Where nothing ends, costs do not matter, and may have any number of digits.
        paid = [int(self.alone.own.split(weight)[0] * self.scale) if ends else 0 for _, _, weight in moves]
        self._order = self._order_of(frozenset(paid))
        for (source, target, _), units in zip(moves, paid, strict=True):
            x = self.model.binary()
            if units:
                self.model.objective[x] = self._order(units)
            rows[source][x] = 1
            if target in ends:
                arrivals[x] = 1
            else:
                rows[target][x] = rows[target].get(x, 0) - 1
        self.model.family = "flow"
        for state, terms in enumerate(rows):
            if state not in ends:
                self.model.add(terms, "==", 1 if state == 0 else 0)
        self.model.family = "eq. 3"
        if 0 not in ends:
            self.model.add(arrivals, ">=", 1)

    def _order_of(self, paid: frozenset[int]) -> OrderOfSums:
        """Smaller numbers where costs are too large for solvers: a path passes no state twice."""
        few = max(paid, default=0) <= limits().coefficient
        return OrderOfSums() if few else OrderOfSums.of(paid, 2 * len(self._number))

    def _moves(self) -> list[tuple[int, int, int]]:
        """All moves from states that the human reaches, the goal's left out: source, target, weight."""
        start, onward, is_end = self.alone.graph()
        states: list[Any] = [] if start is None else [start]
        self._number[start] = 0
        self._ends: list[int] = []
        moves: list[tuple[int, int, int]] = []
        for number, state in enumerate(states):  # grows while it is walked
            self._deadline.check()
            if is_end(state):
                self._ends.append(number)
                continue
            for after, weight, _ in onward(state):
                if after not in self._number:
                    if len(states) >= limits().alone_states:
                        raise HumanTooLargeError
                    self._number[after] = len(states)
                    states.append(after)
                moves.append((number, self._number[after], weight))
        return moves

    def solve(self) -> int | None:
        """The least cost in units, by the solver; None: there is no plan.

        Raises:
            UndecidedError: the solver does not say, or what it says could not be written down.
        """
        outcome = self._effort.solve(self.model)
        if outcome.status == "undecided":
            raise UndecidedError(outcome.reason)
        values: Sequence[int] = outcome.values or ()
        least = units = None
        if outcome.status == "optimal":
            least = sum(weight * values[x] for x, weight in self.model.objective.items())
            units = self._order.bound(least)
            self._effort.calls[-1].objective = self._effort.calls[-1].cost = units
        proof = self._effort.proof
        if proof is not None and not isinstance(proof, ProofReader):
            limit = None if least is None else least - 1
            refute(proof, self._described(), self.model, limit, values, self._deadline)
        return units

    def read(self, proof: ProofReader) -> int | None:
        """The same from a proof that the checker has accepted.

        Raises:
            UndecidedError: its next program is another one, or leaves the answer open.
        """
        entry = proof.take()
        require_same(entry, self._described())
        limit: int | None = entry["limit"]
        if limit is None:
            return None
        if "solution" not in entry and self.model.upper:
            raise UndecidedError(f"program {entry['name']!r}: a solution is missing")
        return self._order.bound(limit + 1)

    def _described(self) -> Entry:
        words = f"the human alone, {len(self._number)} states"
        scale = self.scale if self._order.rests is None else 0
        return described(words, scale, self.model, self._deadline)
