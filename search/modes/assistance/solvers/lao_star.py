"""The best policy, by raising lower bounds along the policy that looks best.

A pass follows the policy that is best by the present bounds, expands what it meets and
backs values up (as in LAO*, Hansen and Zilberstein 2001).  When a pass raises nothing,
the policy is evaluated exactly; if it is worth its bound, it is optimal.  Where runs may
return to a state, backing up alone may not get there: then everything looked at is
solved at once, see :mod:`search.modes.assistance.solvers.cycles`.
"""

from collections.abc import Iterator

from search.modes.assistance.game.game import Game
from search.modes.assistance.game.rules import ChoiceRule, Value
from search.modes.assistance.game.solution import MAX_FLOORS, GameSolution, PolicyEntry
from search.modes.assistance.solvers.cycles import solve_all
from search.modes.assistance.solvers.evaluate import Option, evaluate
from search.modes.assistance.solvers.graph import Graph
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model.answers.policy import Costs

_MOST_BACKUPS = 1000
_MOST_IDLE_PASSES = 20


class LaoStar:
    """The search; its arguments are those of :class:`.Graph`."""

    def __init__(self, game: Game, rule: ChoiceRule, *, no_block: bool) -> None:
        self._game = game
        self._rule = rule
        self._graph = Graph(game, rule, no_block=no_block)
        self._policy: dict[int, Option] = {}
        self._values: dict[int, Value] = {}
        self._upper: Value = rule.infinite
        self.expanded = 0

    def run(self) -> Iterator[None]:
        """Search; yields whenever the best policy known gets better.  At a limit that one stands."""
        graph, game = self._graph, self._game
        if graph.final(game.init):
            self._upper = self._rule.lift(0)
            return
        graph.choice_value(game.init)
        alone = game.alone(game.init)
        if alone < INFINITE_KEY:
            self._upper = self._rule.lift(alone)
            yield
        while graph.choice_value(game.init) < self._upper:
            self._raise_bounds()
            policy = self._best_policy()
            values = evaluate(policy, self._rule, self._without_move, game.deadline)
            value = values.get(game.init, self._rule.infinite)
            if value < self._upper:
                self._upper, self._policy, self._values = value, policy, values
                yield
            if graph.choice_value(game.init) < self._upper:
                solve_all(graph, game.deadline)

    def _raise_bounds(self) -> None:
        """Pass until nothing rises, or nothing new is looked at for a while: then runs return."""
        graph, idle = self._graph, 0
        while idle < _MOST_IDLE_PASSES:
            known = len(graph.replies)
            if not self._pass():
                return
            idle = 0 if len(graph.replies) > known else idle + 1

    def _pass(self) -> bool:
        """Walk once through the best policy; whether a bound rose."""
        graph = self._graph
        rose = False
        seen = {self._game.init}
        stack = [self._game.init]
        while stack:
            state = stack[-1]
            self._game.deadline.tick()
            self.expanded += 1
            higher, after = self._step(state, seen)
            rose |= higher
            if after is None:
                stack.pop()
            else:
                seen.add(after)
                stack.append(after)
        return rose and graph.low[self._game.init] < self._upper

    def _step(self, state: int, seen: set[int]) -> tuple[bool, int | None]:
        """Back a choice up; whether it rose, and an outcome that was not visited yet."""
        graph, rose = self._graph, False
        # A run that returns to the state at once could raise its bound for ever.
        for _ in range(_MOST_BACKUPS):
            move, value = graph.best(state)
            if value > graph.choice_value(state):
                graph.low[state] = value
                rose = True
            if move is None or graph.final(move.after) or value >= self._rule.infinite:
                return rose, None
            if graph.settled(move.after):
                return rose, None
            if not graph.back_up_reply(move.after):
                onward = (outcome.after for outcome in graph.outcomes(state, move))
                return rose, next((at for at in onward if at not in seen and not graph.final(at)), None)
        return rose, None

    def _without_move(self, state: int) -> Value:
        """The value of a state that is final, or lost."""
        return self._rule.lift(0) if self._graph.final(state) else self._rule.infinite

    def _best_policy(self) -> dict[int, Option]:
        """What looks best now, from the initial state on."""
        graph = self._graph
        policy: dict[int, Option] = {}
        pending = [self._game.init]
        while pending:
            self._game.deadline.tick()
            state = pending.pop()
            if state in policy:
                continue
            move, value = graph.best(state)
            if move is None or value >= self._rule.infinite:
                continue
            option = policy[state] = graph.option(state, move)
            pending.extend(outcome.after for outcome in option.outcomes if not graph.final(outcome.after))
        return policy

    def solution(self, *, floors: bool = True) -> GameSolution:
        """The best policy known, and lower bounds on everything looked at."""
        graph, rule, game = self._graph, self._rule, self._game
        policy = {}
        for state, (move, _, _) in self._policy.items():
            value = rule.costs(self._values[state])
            if value is not None:
                policy[state] = PolicyEntry(value, move.action, move.after)
        proof: dict[int, Costs] | None = None
        if floors and len(graph.choices) <= MAX_FLOORS:
            lows = ((state, rule.costs(graph.low[state])) for state in graph.choices)
            proof = {state: low for state, low in lows if low is not None}
        # Bounding the initial state takes time, too: there may be no bound yet.
        lower = rule.lift(0) if graph.final(game.init) else graph.low.get(game.init, rule.lift(0))
        return GameSolution(rule.costs(lower), rule.costs(self._upper), policy, proof)
