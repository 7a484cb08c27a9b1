"""A claim's program made a second time, from the semantics alone: what a plan is, in facts and actions.

``do_A_T`` is 1 where action A is done in epoch T, ``is_F_T`` where fact F is true after it. A window is told
by the epochs that have begun it, ``in_T``, and those that have ended it, ``out_T``. Nothing is left out but
what no plan can reach even if nothing is ever deleted. Costs are exact; ``unit`` is what an objective of 1
costs.

What the verifier's programs know of automata, flows and pruning is nowhere in here.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from math import lcm

from serendipity.model import GroundAction, Task
from serendipity_testing.oracle import Alone, Moment
from serendipity_testing.pseudo_boolean.opb import PseudoBooleanProblem
from serendipity_testing.pseudo_boolean.question import NotMadeError, PlansAsked, require_no_time

Terms = dict[str, int]


def program(question: PlansAsked) -> tuple[PseudoBooleanProblem, Fraction]:
    """The program of a question, and its unit; a NotMadeError for time, and states that are preserved."""
    options = question.options
    require_no_time(question.task, options)
    if question.rule == "every window" and options.preservation == "state":
        raise NotMadeError("preservation state")
    return _Maker(question).made()


class _Maker:
    def __init__(self, question: PlansAsked) -> None:
        self.question, self.task, self.options = question, question.task, question.options
        self.epochs = range(1, question.epochs + 1)
        self.human = self.task.human
        self.problem = PseudoBooleanProblem()
        prices = [self.task.team_cost(one, self.options.discount) for one in self.task.actions]
        talk = [self._talk(i) for i in range(len(self.task.actions))]
        amounts = (*prices, *talk, self.options.window_weight)
        self.scale = lcm(*(amount.denominator for amount in amounts))
        self.price = [int(amount * self.scale) for amount in prices]
        self.weight = [int((a + b) * self.scale) for a, b in zip(prices, talk, strict=True)]

    def made(self) -> tuple[PseudoBooleanProblem, Fraction]:
        """The program and its unit."""
        self.problem.objective = self._sum(self.weight, self.epochs)
        self._states()
        self._epochs()
        if self.question.rule == "every window":
            self._window()
        elif self.question.rule == "pi_H as planned":
            for t in self.epochs:
                self._follow(t, {})
        if self.question.most_cost is not None:
            most = self.question.most_cost * self.scale
            self.problem.add(self._sum(self.price, self.epochs), "<=", int(most // 1))
        return self.problem, Fraction(1, self.scale)

    # -- semantics 1: who may do what, and at what price

    def _is_own(self, action: int) -> bool:
        return self.task.actions[action].participants == (self.human,)

    def _talk(self, action: int) -> Fraction:
        """Semantics 3.4."""
        one = self.task.actions[action]
        told = self.options.mode == "communication" and self.human in one.participants
        weight = self.options.communication_weight
        return one.cost * weight if told and one.name not in self._planned_names else Fraction(0)

    @cached_property
    def _planned_names(self) -> set[str]:
        return {self.task.actions[i].name for i in self.question.human_plan}

    @cached_property
    def _reached(self) -> tuple[dict[int, int], dict[int, int]]:
        """After which epoch each fact may be true if nothing is ever deleted, and when each action."""
        facts, actions = dict.fromkeys(self.task.init, 0), dict[int, int]()
        for t in self.epochs:
            ready = {
                i: t
                for i, one in enumerate(self.task.actions)
                if i not in actions and all(facts.get(f, t) < t for f in one.pre)
                if self.question.robots or self._is_own(i)
            }
            actions |= ready
            for i in ready:
                facts |= {f: t for f in self.task.actions[i].add if f not in facts}
        return facts, actions

    def _usable(self, t: int) -> Iterator[tuple[int, GroundAction, str]]:
        """Actions of an epoch, with their variables."""
        for i, first in self._reached[1].items():
            if first <= t:
                yield i, self.task.actions[i], f"do_{i}_{t}"

    def _sum(self, weights: Sequence[int], epochs: range) -> Terms:
        return {x: weights[i] for t in epochs for i, _, x in self._usable(t) if weights[i]}

    # -- semantics 2: states and epochs

    def _fact(self, f: int, t: int, sign: int = 1) -> tuple[Terms, int]:
        """A fact after an epoch, as terms and a constant, times a sign."""
        if self._reached[0].get(f, t + 1) > t:
            return {}, 0
        if f in self.task.init and (t == 0 or f not in self._deleted):
            return {}, sign
        return {f"is_{f}_{t}": sign}, 0

    @cached_property
    def _deleted(self) -> set[int]:
        return {f for _, one, _ in self._usable(self.epochs[-1]) for f in one.delete}

    def _row(self, *parts: tuple[Terms, int], sense: str = "<=", right: int = 0) -> None:
        """Terms and constants, added up, on the left side."""
        terms: Terms = {}
        for part, constant in parts:
            right -= constant
            for x, a in part.items():
                terms[x] = terms.get(x, 0) + a
        if terms or right < 0 or sense != "<=":
            self.problem.add(terms, sense, right)

    def _states(self) -> None:
        """What was true stays true unless it is deleted; what is added becomes true; conditions; goals."""
        for t in self.epochs:
            adders: dict[int, list[str]] = {}
            deleters: dict[int, list[str]] = {}
            for _, one, x in self._usable(t):
                for f in one.pre:
                    self._row(({x: 1}, 0), self._fact(f, t - 1, -1))
                for f in one.neg:
                    self._row(({x: 1}, -1), self._fact(f, t - 1))
                for changed, ids in ((one.add, adders), (one.delete, deleters)):
                    for f in changed:
                        ids.setdefault(f, []).append(x)
            for f in range(len(self.task.facts)):
                for x in adders.get(f, ()):
                    self._row(({x: 1}, 0), self._fact(f, t, -1))
                gone = dict.fromkeys(deleters.get(f, ()), 1)
                come = dict.fromkeys(adders.get(f, ()), -1)
                self._row(self._fact(f, t), self._fact(f, t - 1, -1), (come, 0))
                self._row(self._fact(f, t - 1), self._fact(f, t, -1), (dict.fromkeys(gone, -1), 0))
                if gone:
                    self._row(self._fact(f, t), (gone, -1))
        last, goals = self.question.epochs, (self.task.goal, self.task.robot_goal)
        for f in (f for goal in goals for f in goal.positive):
            self._row(self._fact(f, last), sense=">=", right=1)
        for f in (f for goal in goals for f in goal.negative):
            self._row(self._fact(f, last))

    def _epochs(self) -> None:
        """One action an agent and epoch; under strict interference none that spoils another's condition."""
        for t in self.epochs:
            for agent in range(len(self.task.agents)):
                his = {x: 1 for _, one, x in self._usable(t) if agent in one.participants}
                self._row((his, -1))
            for _, one, x in self._usable(t) if self.options.strict else ():
                for _, other, z in self._usable(t):
                    spoilt = set(one.delete) & set(other.pre) or set(one.add) & set(other.neg)
                    if x != z and spoilt:
                        self._row(({x: 1, z: 1}, -1))

    # -- semantics 3.1: windows

    def _his(self, t: int) -> Iterator[tuple[int, GroundAction, str]]:
        return (each for each in self._usable(t) if self.human in each[1].participants)

    def _follow(self, t: int, free: Terms) -> None:
        """In this epoch the human does what they have planned, unless ``free``, if there is such, is 1."""
        plan, keeps = self.question.human_plan, self.options.keep_prefix
        planned = plan[t - 1] if t <= len(plan) else None
        minus = dict.fromkeys(free, -1)
        for i, one, x in self._his(t):
            own = not one.joint and one.name in self._planned_names
            if not (own if keeps else i == planned):
                self._row(({x: 1}, 0), (minus, 0))
        if planned is not None and not keeps:
            done = {x: 1 for i, _, x in self._usable(t) if i == planned}
            self._row((done, 0), (free, 0), sense=">=", right=1)

    def _window(self) -> None:
        length: Terms = {}
        for t in self.epochs:
            begun, over = {f"in_{t}": 1}, {f"out_{t}": 1}
            length |= {f"in_{t}": 1, f"out_{t}": -1}
            if t > 1:
                self._row(({f"in_{t - 1}": 1, f"in_{t}": -1}, 0))
                self._row(({f"out_{t - 1}": 1, f"out_{t}": -1}, 0))
                self._row(({f"out_{t}": 1, f"in_{t - 1}": -1}, 0))
            else:
                self._row((over, 0))
            if t >= len(self.question.human_plan):
                self._row((begun, 0), sense=">=", right=1)
            self._follow(t, begun)
            for i, _, x in self._usable(t):
                if not self._is_own(i):
                    self._row(({x: 1}, 0), (over, -1))
        weight = int(self.options.window_weight * self.scale)
        if weight:
            assert self.problem.objective is not None
            self.problem.objective |= {x: weight * a for x, a in length.items()}
        if self.options.max_window is not None:
            self._row((length, -self.options.max_window))
        self._subplan() if self.options.suffix == "subplan" else self._optimal_suffixes()

    def _subplan(self) -> None:
        """``take_K_T``: step K of ``pi_H`` is done in epoch T of the suffix; ``past_K_T``: it is over."""
        steps = range(len(self.question.human_plan))
        for t in self.epochs:
            for k in steps:
                self._row(({f"take_{k}_{t}": 1, f"out_{t}": -1}, 0))
                self._row(({f"take_{k}_{t}": 1, f"past_{k}_{t}": -1}, 0))
                if k:
                    self._row(({f"past_{k}_{t}": 1, f"past_{k - 1}_{t}": -1}, 0))
                if t > 1:
                    self._row(({f"past_{k}_{t - 1}": 1, f"past_{k}_{t}": -1}, 0))
                    self._row(({f"take_{k}_{t}": 1, f"past_{k}_{t - 1}": 1}, -1))
            for i, _, x in self._his(t):
                uses = {f"take_{k}_{t}": -1 for k in steps if self.question.human_plan[k] == i}
                self._row(({x: 1, f"out_{t}": 1, **uses}, -1))

    def _optimal_suffixes(self) -> None:
        """Def. 2.0a: from states that are asked about, a suffix weighs as an optimal plan, or none fits."""
        alone, facts = Alone(self.task), _of_bearing(self.task)
        for xi2, named in self.question.suffixes:
            state = named & facts | self.task.init - facts
            differs, missing = {f"out_{xi2 - 1}": 1, f"out_{xi2}": -1}, 1
            for f in facts:
                terms, constant = self._fact(f, xi2 - 1, -1 if f in state else 1)
                differs |= terms
                missing += constant + (f in state)
            least = self._least_weight(alone, xi2, state)
            if least is None:
                self._row((differs, missing), sense=">=", right=1)
                continue
            his = [self.weight[i] if self._is_own(i) else 0 for i in range(len(self.weight))]
            later = self._sum(his, range(xi2, self.question.epochs + 1))
            scaled = {x: least * a for x, a in differs.items()}
            self._row((scaled, least * missing), (later, 0), sense=">=", right=least)

    def _least_weight(self, alone: Alone, xi2: int, state: frozenset[int]) -> int | None:
        """The least weight of an optimal plan from a state that fits and ends where all goals hold."""
        worth = alone.worth(Moment(state))
        if worth is None or worth[1] > self.question.epochs - xi2 + 1:
            return None
        if worth[1] == 0:
            return 0 if self.task.robot_goal.holds(state) else None
        onward = (
            (step.action, self._least_weight(alone, xi2 + 1, step.moment.state))
            for step in alone.best(Moment(state))
        )
        weights = (self.weight[i] + rest for i, rest in onward if i is not None and rest is not None)
        return min(weights, default=None)


def _of_bearing(task: Task) -> frozenset[int]:
    """Facts that say what the human's optimal plan is: those of the goals, and of how they come about."""
    goals = (task.goal, task.robot_goal)
    facts = {f for goal in goals for f in (*goal.positive, *goal.negative)}
    his = [one for one in _possible(task) if one.participants == (task.human,)]
    before: set[int] = set()
    while before != facts:
        before = set(facts)
        for one in his:
            if not before.isdisjoint((*one.add, *one.delete)):
                facts.update(one.pre, one.neg)
    return frozenset(facts)


def _possible(task: Task) -> list[GroundAction]:
    """Actions that may become applicable if what has once been true stays so, and what has been false."""
    true, false = set(task.init), set(range(len(task.facts))) - task.init
    found: dict[int, GroundAction] = {}
    known = -1
    while known < len(found):
        known = len(found)
        for i, one in enumerate(task.actions):
            if i not in found and true.issuperset(one.pre) and false.issuperset(one.neg):
                found[i] = one
                true.update(one.add)
                false.update(one.delete)
    return [*found.values()]
