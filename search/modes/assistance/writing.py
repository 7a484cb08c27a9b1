"""Writes solutions in the model's terms: names of facts and actions, plans by epochs."""

from contextlib import suppress

from search.modes.assistance.game.game import NOOP, Game, Move
from search.modes.assistance.game.rules import ChoiceRule
from search.modes.assistance.game.solution import GameSolution
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model.answers.policy import Costs, Decision, Floor, Policy, StateDelta
from serendipity.model.errors import LIMITS
from serendipity.model.task.actions import NOOP as NOOP_NAME
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan


class Writer:
    """Names for one game, in which the prime's optimal actions count by a rule."""

    def __init__(self, game: Game, rule: ChoiceRule) -> None:
        self.task = game.task
        self._game = game
        self._rule = rule
        packed = zip(game.task.facts, game.packed.fact_bits, strict=True)
        self._named = {bits: name for name, bits in packed if bits is not None}

    def human_plan(self) -> HumanPlan | None:
        """The prime's canonical optimal plan alone, or None where they have none."""
        game, state = self._game, self._game.init
        if game.alone(state) >= INFINITE_KEY:
            return None
        plan = []
        while not game.goal.holds(state):
            move = game.prime(state)[0]
            plan.append(move.action)
            state = move.after
        return tuple(plan)

    def policy(self, solution: GameSolution) -> Policy:
        """The policy, with its lower bounds where there is time to write them down."""
        decisions = tuple(
            Decision(self._delta(state), self._name(entry.action), entry.value)
            for state, entry in solution.policy.items()
        )
        floors = None
        if solution.floors is not None:
            with suppress(*LIMITS):
                each = self._game.deadline.each(solution.floors.items())
                floors = tuple(Floor(self._delta(state), value) for state, value in each)
        return Policy(decisions, floors)

    def plan(self, solution: GameSolution) -> tuple[Step, ...] | None:
        """The only run of a policy; None where the prime's choices make several."""
        game, state, helping = self._game, self._game.init, True
        steps: list[Step] = []
        epoch = 0
        while not game.goal.holds(state):
            epoch += 1
            entry = solution.policy.get(state) if helping else None
            helping = entry is not None
            rest: Costs | None = None
            if entry is not None:
                state, rest = entry.after, entry.value
                if entry.action != NOOP:
                    steps.append(Step(epoch, entry.action))
                    rest = rest[0], rest[1] - self.task.actions[entry.action].cost
                if game.goal.holds(state):
                    break
            move = self._reply(state, solution, rest)
            if move is None:
                return None
            if move.action != NOOP:
                steps.append(Step(epoch, move.action))
            state = move.after
        return tuple(steps)

    def _reply(self, state: int, solution: GameSolution, rest: Costs | None) -> Move | None:
        """The prime's move, where it is determined."""
        if self._game.alone(state) >= INFINITE_KEY:
            return Move(0, state, NOOP)
        moves = self._rule.counted(self._game.prime(state))
        if len(moves) > 1 and not self._rule.is_ours:
            return None
        return next((move for move in moves if self._attains(move, solution, rest)), moves[0])

    def _attains(self, move: Move, solution: GameSolution, rest: Costs | None) -> bool:
        """Whether the best run goes on with this move."""
        if rest is None:
            return True
        cost = self._game.pair(move.value)
        if self._game.goal.holds(move.after):
            return rest == cost
        entry = solution.policy.get(move.after)
        return entry is not None and (entry.value[0] + cost[0], entry.value[1] + cost[1]) == rest

    def _name(self, action: int) -> str:
        return NOOP_NAME if action == NOOP else self._game.task.actions[action].name

    def _delta(self, state: int) -> StateDelta:
        packed, init = self._game.packed, self._game.init
        fields = [field for field in packed.fields if (state ^ init) & field]
        facts = ([self._named.get((field, at & field)) for field in fields] for at in (state, init))
        return StateDelta(*(tuple(sorted(filter(None, names))) for names in facts))
