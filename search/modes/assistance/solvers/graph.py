"""The part of the game that has been looked at, with lower bounds that only rise.

A *choice* is a state with the supporter to move, a *reply* one with the prime to move.
"""

from collections.abc import Iterable

from search.modes.assistance.bounds.bound import ValueBound
from search.modes.assistance.game.game import NOOP, Game, Move
from search.modes.assistance.game.rules import ChoiceRule, Value
from search.modes.assistance.solvers.evaluate import Option
from search.packed.cost_vector import INFINITE_KEY


class Graph:
    """Choices and replies, expanded when first needed.

    Args:
        no_block: no move may take the prime's last plan away.

    Attributes:
        final: whether the goal holds in a state.
        choices: per expanded choice the supporter's moves, the promising ones first.
        replies: per expanded reply the prime's moves; one wait where they have no plan.
        low: lower bounds of choices.
        reply_low: lower bounds of replies; absent where the bound was not worked out yet.
        idle: per expanded reply its value if the supporter does nothing any more.
        pick: the options of a policy that is known to end, where one was worked out.
    """

    def __init__(self, game: Game, rule: ChoiceRule, *, no_block: bool) -> None:
        self.game = game
        self.rule = rule
        self._bound = ValueBound(game)
        self._no_block = no_block
        self.choices: dict[int, list[Move]] = {}
        self.replies: dict[int, tuple[Move, ...]] = {}
        self.low: dict[int, Value] = {}
        self.reply_low: dict[int, Value] = {}
        self.idle: dict[int, Value] = {}
        self.pick: dict[int, Option] = {}
        self._inherited: dict[int, Value] = {}
        self.final = game.goal.holds

    def choice_value(self, state: int) -> Value:
        """Lower bound of a state after the prime's move."""
        if self.final(state):
            return self.rule.lift(0)
        value = self.low.get(state)
        if value is None:
            value = self.low[state] = self.rule.lift(self._bound(state))
        return value

    def move_value(self, state: int, move: Move) -> Value:
        """Lower bound of a supporter's move from ``state``."""
        if self.final(move.after):
            return self.rule.lift(move.value)
        low = self.reply_low.get(move.after)
        if low is None:  # bounds are consistent: no move is below its state's first bound
            return self._inherited[state]
        return self.rule.add(move.value, low)

    def best(self, state: int) -> tuple[Move | None, Value]:
        """The supporter's best move by the present bounds, its reply expanded; None if there is none.

        Of equals the one of ``pick``, then one whose reply is expanded, then the first.
        """
        moves = self._choice(state)
        while moves:
            move, value = self._least(state, moves)
            at = move.after
            if self.final(at):
                return move, value
            if at not in self.reply_low:
                self.reply_low[at] = self.rule.lift(self._bound(at))
                continue
            risen = at not in self.replies and self._expand_reply(at)
            if not self._forbidden(state, move) and not risen:
                return move, value
        return None, self.rule.infinite

    def _least(self, state: int, moves: list[Move]) -> tuple[Move, Value]:
        pick = self.pick.get(state)
        best, value, rank = moves[0], None, 3
        for move in moves:
            v = self.move_value(state, move)
            if value is not None and v > value:
                continue
            r = 0 if pick is not None and move == pick.move else 1 if move.after in self.replies else 2
            if value is None or v < value or r < rank:
                best, value, rank = move, v, r
        return best, value

    def _expand_reply(self, at: int) -> bool:
        """Work out what the prime may do; whether that raised the reply's bound."""
        alone = self.game.alone(at)
        self.idle[at] = self.rule.lift(alone)
        if alone < INFINITE_KEY:
            self.replies[at] = self.rule.counted(self.game.prime(at))
        else:
            self.replies[at] = (Move(0, at, NOOP),)
        return self.back_up_reply(at)

    def _forbidden(self, state: int, move: Move) -> bool:
        """Drop ``move`` if it is not allowed, or only repeats the state; whether it was dropped."""
        if self.idle[move.after] != self.rule.infinite:
            return False
        blocks = self._no_block and move.action != NOOP and self.game.alone(state) < INFINITE_KEY
        if blocks or move.after == state:
            self.choices[state].remove(move)
            return True
        return False

    def back_up_reply(self, at: int) -> bool:
        """Raise a reply's bound to what its outcomes say; whether it rose."""
        value = self.rule.combine(
            [self.rule.add(move.value, self.choice_value(move.after)) for move in self.replies[at]]
        )
        low = self.reply_low.get(at)
        if low is None or value > low:
            self.reply_low[at] = value
            return True
        return False

    def settled(self, at: int) -> bool:
        """Whether doing nothing any more after this is as good as can be."""
        return bool(self.idle[at] == self.reply_low[at])

    def option(self, state: int, move: Move) -> Option:
        """A move of an expanded choice with all that is known of what follows."""
        at = move.after
        if self.final(at):
            return Option(move, self.rule.lift(0), ())
        if at not in self.replies:
            low = self.reply_low.get(at)
            return Option(move, self.rule.lift(self._bound(at)) if low is None else low, ())
        if self.settled(at):
            return Option(move, self.idle[at], ())
        return Option(move, None, self.outcomes(state, move))

    def options(self, state: int, move: Move) -> Iterable[Option]:
        """The same, one for each reply of the prime's where we choose that, too."""
        option = self.option(state, move)
        if option.outcomes and self.rule.is_ours:
            return [option._replace(outcomes=(reply,)) for reply in self.replies[move.after]]
        return [option]

    def outcomes(self, state: int, move: Move) -> tuple[Move, ...]:
        """The prime's moves after an expanded one of ours; where we choose, the best, first the picked."""
        replies, pick = self.replies[move.after], self.pick.get(state)
        if not self.rule.is_ours:
            return replies
        picked = pick.outcomes if pick is not None and pick.move == move else ()

        def order(reply: Move) -> tuple[Value, bool]:
            return self.rule.add(reply.value, self.choice_value(reply.after)), reply not in picked

        return (min(replies, key=order),)

    def _choice(self, state: int) -> list[Move]:
        moves = self.choices.get(state)
        if moves is None:
            self._inherited[state] = self.choice_value(state)
            wanted = self._bound.wanted(state)
            moves = self.game.supporter(state)
            moves.sort(key=lambda move: (move.action not in wanted, move.action != NOOP))
            self.choices[state] = moves
        return moves
