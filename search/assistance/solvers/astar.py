"""Optimistic and fixed: the cheapest run, by A* over (state, who is to move).

Bounds are worked out when a node comes up, not when it is generated; of equals the
latest comes first, and first of all what a plan that attains the bound would do.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import NamedTuple

from search.assistance.bounds.bound import Bound
from search.assistance.game.game import INFINITE, NOOP, Game, Move
from search.assistance.game.solution import MAX_FLOORS, ZERO, Costs, Entry, Solution


class _Node(NamedTuple):
    """A state, who is to move, how it was reached."""

    state: int
    primes: bool
    """The prime is to move."""
    cost: int
    parent: "_Node | None"
    action: int


@dataclass(slots=True)
class _Best:
    """The cheapest complete run: it ends in ``node``, or the supporter idles from there on."""

    value: int
    node: _Node | None = None


class AStar:
    """The search.

    Args:
        game: the game.
        bound: consistent lower bound.
        fixed: the prime takes his smallest action, else the best one for us.
        no_block: no move may take the prime's last plan away.
    """

    def __init__(self, game: Game, bound: Bound, *, fixed: bool, no_block: bool) -> None:
        self._game = game
        self._bound = bound
        self._fixed = fixed
        self._no_block = no_block
        self._count = 0
        self._queue: list[tuple[int, int, bool, _Node]] = []
        self._cheapest: dict[tuple[int, bool], int] = {}
        self._closed: dict[int, int] = {}
        self._best = _Best(INFINITE)
        self.expanded = 0
        self.lower = 0

    @property
    def upper(self) -> int:
        """The value of the best run found."""
        return self._best.value

    def run(self) -> Iterator[None]:
        """Search; yields whenever ``upper`` falls.  On return it is the optimum.

        Raises:
            LimitReachedError: the deadline ran out; ``lower``, ``upper`` and the solution stand.
        """
        game = self._game
        root = _Node(game.init, False, 0, None, NOOP)
        if game.goal.holds(game.init):
            self._best = _Best(0, root)
        self._push(root, self._bound(game.init), ready=True)
        while self._queue:
            game.deadline.tick()
            f, _, ready, node = heappop(self._queue)
            if f >= self._best.value:
                break
            self.lower = max(self.lower, f)
            if self._cheapest[node.state, node.primes] < node.cost:
                continue
            if not ready:
                estimate = node.cost + self._bound(node.state)
                if estimate > f:
                    self._push(node, estimate, ready=True)
                    continue
            self.expanded += 1
            known = self._best.value
            self._expand(node, f)
            if self._best.value < known:
                yield
        self.lower = self._best.value

    def _expand(self, node: _Node, f: int) -> None:
        if node.primes:
            self._prime(node, f)
        else:
            self._closed[node.state] = node.cost
            self._supporter(node, f)

    def _supporter(self, node: _Node, f: int) -> None:
        wanted = self._bound.wanted(node.state)
        moves = self._game.supporter(node.state)
        # The last one pushed comes up first: what is wanted, else waiting.
        moves.sort(key=lambda move: (move.action in wanted, move.action == NOOP))
        for move in moves:
            self._reach(node, move, primes=True, f=f)

    def _prime(self, node: _Node, f: int) -> None:
        game = self._game
        alone = game.alone(node.state)
        if alone >= INFINITE:
            if self._blocks(node):
                return
            if node.parent is not None and node.parent.state != node.state:
                self._reach(node, Move(0, node.state, NOOP), primes=False, f=f)
            return
        if node.cost + alone < self._best.value:
            self._best = _Best(node.cost + alone, node)
        moves = game.prime(node.state)
        for move in moves[:1] if self._fixed else reversed(moves):
            self._reach(node, move, primes=False, f=f)

    def _blocks(self, node: _Node) -> bool:
        """Whether the supporter's move to a state without a plan took the plan away."""
        before = node.parent
        return self._no_block and before is not None and self._game.alone(before.state) < INFINITE

    def _reach(self, parent: _Node, move: Move, *, primes: bool, f: int) -> None:
        node = _Node(move.after, primes, parent.cost + move.value, parent, move.action)
        if node.cost >= self._best.value:
            return
        if self._game.goal.holds(move.after):
            self._best = _Best(node.cost, node)
            return
        self._push(node, f, ready=False)

    def _push(self, node: _Node, f: int, *, ready: bool) -> None:
        form = (node.state, node.primes)
        if not ready and self._cheapest.get(form, INFINITE) <= node.cost:
            return
        self._cheapest[form] = node.cost
        self._count -= 1
        heappush(self._queue, (f, self._count, ready, node))

    def solution(self, *, floors: bool = True) -> Solution:
        """The best run as a policy, and lower bounds on what was expanded."""
        game, best = self._game, self._best
        policy: dict[int, Entry] = {}
        node = best.node
        while node is not None and node.parent is not None:
            if node.primes:
                value = game.pair(best.value - node.parent.cost)
                policy[node.parent.state] = Entry(value, node.action, node.state)
            node = node.parent
        proof: dict[int, Costs] | None = None
        if floors and len(self._closed) <= MAX_FLOORS:
            known = self._closed if self.lower < INFINITE else {}
            proof = {s: self._rest(cost) for s, cost in known.items()}
        return Solution(
            lower=None if self.lower >= INFINITE else game.pair(self.lower),
            upper=None if best.value >= INFINITE else game.pair(best.value),
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
