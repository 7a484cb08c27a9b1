"""Optimistic and fixed: the cheapest run, by A* over (state, who is to move).

Bounds are worked out when a node comes up, not when it is generated; of equals the
latest comes first, and first of all what a plan that attains the bound would do.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from search.engine.best_first import Progress, best_first
from search.modes.assistance.bounds.bound import ValueBound
from search.modes.assistance.game.game import NOOP, Game, Move
from search.modes.assistance.game.solution import MAX_FLOORS, ZERO, Costs, GameSolution, PolicyEntry
from search.packed.cost_vector import INFINITE_KEY


class _RunNode(NamedTuple):
    """A state, who is to move, how it was reached."""

    state: int
    primes: bool
    """The prime is to move."""
    cost: int
    parent: "_RunNode | None"
    action: int
    bound: int
    """No run over here has a smaller value."""
    ready: bool
    """Whether the bound is its own; else it is its parent's."""


@dataclass(slots=True)
class _Best:
    """The cheapest complete run: it ends in ``node``, or the supporter idles from there on."""

    key: int
    node: _RunNode | None = None


class CheapestRun:
    """The search: a space for :func:`.best_first`.

    Args:
        bound: consistent lower bound.
        fixed: the prime takes their smallest action, else the best one for us.
        no_block: no move may take the prime's last plan away.
    """

    def __init__(self, game: Game, bound: ValueBound, *, fixed: bool, no_block: bool) -> None:
        self._game = game
        self._bound = bound
        self._fixed = fixed
        self._no_block = no_block
        self._cheapest: dict[tuple[int, bool], int] = {}
        self._closed: dict[int, int] = {}
        self._best = _Best(INFINITE_KEY)
        self._progress = Progress()
        self.expanded = 0

    @property
    def upper(self) -> int:
        """The value of the best run found."""
        return self._best.key

    @property
    def lower(self) -> int:
        """A value that no run undercuts."""
        return self._progress.bound

    def run(self) -> Iterator[None]:
        """Search; yields whenever ``upper`` falls.  On return it is the optimum.

        Raises:
            LimitReachedError: the deadline ran out; ``lower``, ``upper`` and the solution stand.
        """
        known = self.upper
        for _ in best_first(self, self._best, self._progress, self._game.deadline):
            if self.upper < known:
                known = self.upper
                yield

    def roots(self) -> Iterator[tuple[int, _RunNode]]:
        """The initial state, the supporter to move."""
        init = self._game.init
        root = _RunNode(init, False, 0, None, NOOP, self._bound(init), True)
        if self._game.goal.holds(init):
            self._best.key, self._best.node = 0, root
        self._cheapest[init, False] = 0
        yield root.bound, root

    def alive(self, node: _RunNode) -> bool:
        """Whether no cheaper way to the same has been found."""
        return self._cheapest[node.state, node.primes] >= node.cost

    def expand(self, node: _RunNode, best: _Best) -> Iterator[tuple[int, _RunNode]]:
        """What the next move leads to; the node itself, where its own bound turns out to be higher."""
        if not node.ready:
            estimate = node.cost + self._bound(node.state)
            if estimate > node.bound:
                yield estimate, node._replace(bound=estimate, ready=True)
                return
        self.expanded += 1
        if node.primes:
            yield from self._prime(node, best)
        else:
            self._closed[node.state] = node.cost
            yield from self._supporter(node, best)

    def _supporter(self, node: _RunNode, best: _Best) -> Iterator[tuple[int, _RunNode]]:
        wanted = self._bound.wanted(node.state)
        moves = self._game.supporter(node.state)
        # The last one comes up first: what is wanted, else waiting.
        moves.sort(key=lambda move: (move.action in wanted, move.action == NOOP))
        for move in moves:
            yield from self._reach(node, move, best)

    def _prime(self, node: _RunNode, best: _Best) -> Iterator[tuple[int, _RunNode]]:
        game = self._game
        alone = game.alone(node.state)
        if alone >= INFINITE_KEY:
            if not self._blocks(node) and node.parent is not None and node.parent.state != node.state:
                yield from self._reach(node, Move(0, node.state, NOOP), best)
            return
        if node.cost + alone < best.key:
            best.key, best.node = node.cost + alone, node
        moves = game.prime(node.state)
        for move in moves[:1] if self._fixed else reversed(moves):
            yield from self._reach(node, move, best)

    def _blocks(self, node: _RunNode) -> bool:
        """Whether the supporter's move to a state without a plan took the plan away."""
        before = node.parent
        return self._no_block and before is not None and self._game.alone(before.state) < INFINITE_KEY

    def _reach(self, parent: _RunNode, move: Move, best: _Best) -> Iterator[tuple[int, _RunNode]]:
        """The node after a move, if nothing as cheap is known; its bound is worked out when it comes up."""
        cost, primes = parent.cost + move.value, not parent.primes
        if cost >= best.key:
            return
        node = _RunNode(move.after, primes, cost, parent, move.action, parent.bound, False)
        if self._game.goal.holds(move.after):
            best.key, best.node = cost, node
        elif cost < self._cheapest.get((move.after, primes), INFINITE_KEY):
            self._cheapest[move.after, primes] = cost
            yield parent.bound, node

    def solution(self, *, floors: bool = True) -> GameSolution:
        """The best run as a policy, and lower bounds on what was expanded."""
        game, best = self._game, self._best
        policy: dict[int, PolicyEntry] = {}
        node = best.node
        while node is not None and node.parent is not None:
            if node.primes:
                value = game.pair(best.key - node.parent.cost)
                policy[node.parent.state] = PolicyEntry(value, node.action, node.state)
            node = node.parent
        proof: dict[int, Costs] | None = None
        if floors and len(self._closed) <= MAX_FLOORS:
            known = self._closed if self.lower < INFINITE_KEY else {}
            proof = {s: self._rest(cost) for s, cost in known.items()}
        return GameSolution(
            lower=None if self.lower >= INFINITE_KEY else game.pair(self.lower),
            upper=None if best.key >= INFINITE_KEY else game.pair(best.key),
            policy=dict(reversed(policy.items())),
            floors=proof,
        )

    def _rest(self, cost: int) -> Costs:
        """What is at least missing to the optimum after ``cost``; no cost is below 0."""
        game = self._game
        (prime, supporter), spent = game.pair(self.lower), game.pair(cost)
        prime, supporter = prime - spent[0], supporter - spent[1]
        if prime < 0:
            return ZERO
        return prime, max(supporter, ZERO[1])
