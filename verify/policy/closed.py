"""Is a policy closed, does it end, are its values consistent?"""

from fractions import Fraction

from serendipity.model.answers.policy import Decision
from verify.policy.board import NOTHING, Board, Costs, Reply
from verify.policy.ending import END, forced
from verify.policy.reading import combine, plus, show


class BrokenError(Exception):
    """A rule of semantics 7 that the policy breaks; its text names the rule, which belongs to a claim."""

    def __init__(self, claim: str, message: str) -> None:
        super().__init__(message)
        self.claim = claim


class Walk:
    """Walks through every state that a policy can meet; ``listed`` is what it says of them."""

    def __init__(self, board: Board, listed: dict[int, Decision]) -> None:
        self._board = board
        self._listed = listed
        self._onward: dict[int, list[int]] = {}
        self._ends: set[int] = set()

    def value(self) -> Costs:
        """What the policy is worth in ``I``, or raise a BrokenError."""
        start = self._board.start
        pending = [start] if start in self._listed else []
        while pending:
            state = pending.pop()
            if state not in self._onward:
                self._round(state)
                pending.extend(self._onward[state])
        if len(self._onward) < len(self._listed):
            raise BrokenError("replay", "a state is listed that the policy does not meet")
        if start not in self._listed:
            return self._idle(start)
        self._require_an_end()
        return self._listed[start].value

    def _idle(self, state: int) -> Costs:
        """Doing nothing for ever."""
        if self._board.goal.holds(state):
            return NOTHING
        alone = self._board.alone(state)
        if alone is None:
            raise BrokenError(
                "replay", "the supporter idles in a state from which the human has no plan alone"
            )
        return alone, Fraction(0)

    def _round(self, state: int) -> None:
        """One round from a listed state: the values after it must make its value."""
        listed = self._listed[state]
        if self._board.goal.holds(state):
            raise BrokenError("replay", "a state is listed in which the goal holds already")
        cost, middle = self._move(state, listed.action)
        self._onward[state] = []
        if self._board.goal.holds(middle):
            self._ends.add(state)
            self._compare(listed, (Fraction(0), cost))
            return
        replies = self._board.replies(middle)
        values = [plus(reply, self._after(reply)) for reply in replies]
        combined = combine(self._board.ties, values)
        self._compare(listed, (combined[0], combined[1] + cost))
        for reply, value in zip(replies, values, strict=True):
            if self._board.ties == "optimistic" and value != combined:
                continue  # this is not the action that the value counts on
            if reply.state in self._listed and not self._board.goal.holds(reply.state):
                self._onward[state].append(reply.state)
            else:
                self._ends.add(state)

    def _move(self, state: int, name: str) -> tuple[Fraction, int]:
        for cost, after, action in self._board.moves(state):
            if action == name:
                if self._board.blocks(name, state, after):
                    raise BrokenError("replay", f"'{name}' leaves the human without a plan")
                return cost, after
        useless = self._board.useless(name, state)
        if useless is None:
            raise BrokenError("replay", f"the supporter can't do '{name}' where the policy says so")
        return useless, state

    def _after(self, reply: Reply) -> Costs:
        if self._board.goal.holds(reply.state):
            return NOTHING
        listed = self._listed.get(reply.state)
        return self._idle(reply.state) if listed is None else listed.value

    def _compare(self, listed: Decision, value: Costs) -> None:
        if listed.value != value:
            raise BrokenError(
                "cost",
                f"where the supporter does '{listed.action}' the value is given as {show(listed.value)}; "
                f"one round and the values after it make {show(value)}",
            )

    def _require_an_end(self) -> None:
        """Every run ends: with certainty; where ties are expected, with probability 1."""
        ties, onward = self._board.ties, self._onward.items()
        choices = {s: [[*after, *[END] * (s in self._ends)]] for s, after in onward}
        settled = forced(choices, self._board.deadline, every=ties in ("robust", "fixed"))
        surely = ties != "expected" or settled.issuperset(choices)
        if self._board.start not in settled or not surely:
            raise BrokenError("replay", "a run of the policy may go on for ever")
