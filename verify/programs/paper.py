"""The paper's integer program, equations (1)-(14), with the errata of semantics 4.

One method for each constraint family, named after its equation.  ``x[a, t]``: action a in
epoch t; ``y[f, t]``: fact f after it; ``begins[t]``, ``ends[t]``: whether xi1, xi2 is t.
"""

from functools import cached_property
from typing import Final

from serendipity.model import Step, Window
from verify.base.control import expected_states
from verify.base.subproblem import EXACT, WINDOW, Subproblem, in_plan
from verify.base.undecided import during
from verify.solvers.mip import BYTES_A_TERM, Model

_Sum = dict[int, int]

_BYTES_A_COLUMN: Final = 750


class PaperEncoding:
    """The reference encoding of a question; ``model`` is its program."""

    def __init__(self, question: Subproblem) -> None:
        """Build the program.  The horizon has to be at least 1."""
        self.question = question
        self.task = question.task
        self.last = question.horizon
        self.epochs = range(1, question.horizon + 1)
        self.actions = question.allowed()
        self.human = self.task.human
        self.deadline = question.deadline
        with during(f"writing a program for {len(self.actions):,} actions over {self.last} epochs"):
            self._require_memory()
            self._write()

    def _write(self) -> None:
        question = self.question
        # without a presolve HiGHS takes minutes where it takes seconds
        self.model = Model(self.deadline, presolve=True)
        self.x = {(a, t): self.model.binary() for a in self.actions for t in self.epochs}
        self.y = {(f, t): self.model.binary() for f in range(len(self.task.facts)) for t in (0, *self.epochs)}
        self._objective()
        self.equations_1_and_2()
        self.equation_3()
        self.equation_4()
        self.equation_5()
        self.equation_6()
        self.equation_10()
        self.strict_interference()
        if question.rule == WINDOW:
            self._window()
        elif question.rule == EXACT:
            self.executes_pi_h()
        self.equation_11()

    def _require_memory(self) -> None:
        """Ask for the memory of the program's columns and of its larger families of rows."""
        columns = self.last * (len(self.actions) + len(self.task.facts))
        terms = len(self.task.facts) * 6
        for a in self.deadline.each(self.actions):
            action = self.task.actions[a]
            terms += 2 * (len(action.pre) + len(action.neg)) + 5 * (len(action.add) + len(action.delete)) + 3
        self.deadline.require(_BYTES_A_COLUMN * columns + BYTES_A_TERM * self.last * terms)

    # -- what every mode has

    def _objective(self) -> None:
        prices = self.question.prices
        for (a, _), x in self.deadline.each(self.x.items()):
            weight = prices.team[a] + prices.talk[a]
            if weight:
                self.model.objective[x] = weight

    def equations_1_and_2(self) -> None:
        """The initial state."""
        self.model.family = "eq. 1, 2"
        for f in range(len(self.task.facts)):
            self.model.add({self.y[f, 0]: 1}, "==", int(f in self.task.init))

    def equation_3(self) -> None:
        """The goals hold in the last state."""
        self.model.family = "eq. 3"
        for f in self.question.goal.positive:
            self.model.add({self.y[f, self.last]: 1}, "==", 1)
        for f in self.question.goal.negative:
            self.model.add({self.y[f, self.last]: 1}, "==", 0)

    def equation_4(self) -> None:
        """Preconditions, negative ones too."""
        self.model.family = "eq. 4"
        for (a, t), x in self.x.items():
            for f in self.task.actions[a].pre:
                self.model.add({x: 1, self.y[f, t - 1]: -1}, "<=", 0)
            for f in self.task.actions[a].neg:
                self.model.add({x: 1, self.y[f, t - 1]: 1}, "<=", 1)

    def equation_5(self) -> None:
        """A fact becomes true by an add effect only, and then it does: the exact frame."""
        self.model.family = "eq. 5"
        for f in range(len(self.task.facts)):
            adders = [a for a in self.deadline.each(self.actions) if f in self.task.actions[a].add]
            for t in self.epochs:
                sums = {self.x[a, t]: -1 for a in adders}
                self.model.add({self.y[f, t]: 1, self.y[f, t - 1]: -1, **sums}, "<=", 0)
                for a in adders:
                    self.model.add({self.y[f, t]: -1, self.x[a, t]: 1}, "<=", 0)

    def equation_6(self) -> None:
        """A fact becomes false by one delete effect only, and then it does."""
        self.model.family = "eq. 6"
        for f in range(len(self.task.facts)):
            deleters = [a for a in self.deadline.each(self.actions) if f in self.task.actions[a].delete]
            for t in self.epochs:
                sums = {self.x[a, t]: 1 for a in deleters}
                if sums:
                    self.model.add({self.y[f, t]: 1, **sums}, "<=", 1)
                frame = {self.y[f, t - 1]: 1, self.y[f, t]: -1}
                self.model.add({**frame, **dict.fromkeys(sums, -1)}, "<=", 0)

    def equation_10(self) -> None:
        """Each agent takes part in at most one action an epoch."""
        self.model.family = "eq. 10"
        for agent in range(len(self.task.agents)):
            his = [a for a in self.deadline.each(self.actions) if agent in self.task.actions[a].participants]
            for t in self.epochs:
                terms = {self.x[a, t]: 1 for a in self.deadline.each(his)}
                if terms:
                    self.model.add(terms, "<=", 1)

    def strict_interference(self) -> None:
        """For-all-step semantics, where asked for: nobody spoils what another action needs."""
        self.model.family = "strict interference"
        if not self.question.options.strict:
            return
        for a in self.actions:
            one = self.task.actions[a]
            for b in self.deadline.each(self.actions):
                other = self.task.actions[b]
                if a != b and (set(one.pre) & set(other.delete) or set(one.neg) & set(other.add)):
                    for t in self.epochs:
                        self.model.add({self.x[a, t]: 1, self.x[b, t]: 1}, "<=", 1)

    def equation_11(self) -> None:
        """Limits on objective and cost."""
        self.model.family = "eq. 11"
        question = self.question
        if question.most is not None and self.model.objective:
            self.model.add(dict(self.model.objective), "<=", question.most)
        items = self.deadline.each(self.x.items())
        cost = {x: question.prices.team[a] for (a, _), x in items if question.prices.team[a]}
        if question.most_cost is not None and cost:
            self.model.add(cost, "<=", question.most_cost)

    def executes_pi_h(self) -> None:
        """The human does ``pi_H[t]`` in each epoch, and nothing after its end."""
        self.model.family = "pi_H"
        for t in self.epochs:
            planned = self._planned(t)
            for a in self.his:
                self.model.add({self.x[a, t]: 1}, "==", int(a == planned))

    # -- windows

    def _window(self) -> None:
        plan = self.question.human_plan
        self.begins = {t: self.model.binary() for t in self.epochs if t <= len(plan)}
        self.ends = {t: self.model.binary() for t in range(2, self.last + 2)}
        self.equation_12()
        if self.question.options.keep_prefix:
            self.second_equation_7b()
        else:
            self.equation_7b()
        self.equation_8()
        if self.question.options.preservation == "state":
            self.preserved_state()
        elif self.question.options.suffix == "subplan":
            self.equation_9()

    def equation_12(self) -> None:
        """xi1 < xi2, both exist, and ``K (xi2 - xi1)`` joins the objective."""
        self.model.family = "eq. 12"
        model, weight = self.model, self.question.prices.epoch
        model.add(dict.fromkeys(self.begins.values(), 1), "==", 1)
        model.add(dict.fromkeys(self.ends.values(), 1), "==", 1)
        length = {b: -t for t, b in self.begins.items()} | {e: t for t, e in self.ends.items()}
        model.add(length, ">=", 1)
        if self.question.options.max_window is not None:
            model.add(length, "<=", self.question.options.max_window)
        if weight:
            model.objective.update({column: weight * t for column, t in length.items()})

    def equation_7b(self) -> None:
        """Before xi1 the human does ``pi_H[t]``; by (10) nothing else, joint actions included (7a)."""
        self.model.family = "eq. 7b"
        for t in self.epochs:
            planned = self._planned(t)
            if planned is not None:
                self.model.add({self.x[planned, t]: 1, **self._later_begin(t, -1)}, ">=", 0)

    def second_equation_7b(self) -> None:
        """Before xi1 the human does actions of ``pi_H`` only, or waits."""
        self.model.family = "eq. 7b"
        planned = in_plan(self.task, self.question.human_plan)
        for t in self.epochs:
            for a in self.his:
                if a not in planned or self.task.actions[a].joint:
                    self.model.add({self.x[a, t]: 1, **self._later_begin(t, 1)}, "<=", 1)

    def equation_8(self) -> None:
        """From xi2 on no robot takes part in anything, joint actions included."""
        self.model.family = "eq. 8"
        for (a, t), x in self.x.items():
            if self.task.actions[a].participants != (self.human,):
                self.model.add({x: 1, **self._ended(t, 1)}, "<=", 1)

    def equation_9(self) -> None:
        """Def. 2.0: from xi2 on a subsequence of ``pi_H``, each index once and in order."""
        self.model.family = "eq. 9"
        place = {(k, t): self.model.binary() for k in self._indices for t in self.epochs}
        self._follow_indices(place)
        for k in self._indices:
            self.model.add({place[k, t]: 1 for t in self.epochs}, "<=", 1)

    def preserved_state(self) -> None:
        """Def. 3.1 read literally: the state contains ``delta(I, pi_H[1..j])``; ``pi_H[j+1..]`` follows."""
        self.model.family = "Def. 3.1"
        model, expected = self.model, expected_states(self.question)
        place = {(k, t): model.binary() for k in self._indices for t in self.epochs}
        chosen = [model.binary() for _ in expected]
        model.add(dict.fromkeys(chosen, 1), "==", 1)
        order = {column: j for j, column in enumerate(chosen)}
        model.add({**order, **{b: -t for t, b in self.begins.items()}}, ">=", -1)
        self._follow_indices(place)
        for k in self._indices:
            # pi_H[k] (from 0) is done in the suffix exactly if j <= k
            done = {place[k, t]: 1 for t in self.epochs} | {chosen[j]: -1 for j in range(k + 1)}
            model.add(done, "==", 0)
        for j, facts in enumerate(expected):
            for t, end in self.ends.items():
                for f in facts:
                    model.add({chosen[j]: 1, end: 1, self.y[f, t - 1]: -1}, "<=", 1)

    def _follow_indices(self, place: dict[tuple[int, int], int]) -> None:
        """``place[k, t]``: the human does ``pi_H[k]`` in epoch t of the suffix, indices rising."""
        model, plan = self.model, self.question.human_plan
        for t in self.epochs:
            for a in self.his:
                uses = {place[k, t]: -1 for k in self._indices if plan[k] == a}
                model.add({self.x[a, t]: 1, **uses, **self._ended(t, 1)}, "<=", 1)
            for k in self._indices:
                model.add({place[k, t]: 1, self.x[plan[k], t]: -1}, "<=", 0)
                model.add({place[k, t]: 1, **self._ended(t, -1)}, "<=", 0)
                later = {place[i, s]: 1 for i in self._indices if i <= k for s in self.epochs if s > t}
                for column in later:
                    model.add({place[k, t]: 1, column: 1}, "<=", 1)
            model.add({place[k, t]: 1 for k in self._indices}, "<=", 1)

    def _later_begin(self, t: int, sign: int) -> _Sum:
        """Whether xi1 > t."""
        return {b: sign for s, b in self.begins.items() if s > t}

    def _ended(self, t: int, sign: int) -> _Sum:
        """Whether xi2 <= t."""
        return {e: sign for s, e in self.ends.items() if s <= t}

    def _planned(self, t: int) -> int | None:
        plan = self.question.human_plan
        return plan[t - 1] if t <= len(plan) else None

    @property
    def _indices(self) -> range:
        return range(len(self.question.human_plan))

    @cached_property
    def his(self) -> list[int]:
        """Actions in which the human takes part."""
        actions = self.deadline.each(self.actions)
        return [a for a in actions if self.human in self.task.actions[a].participants]

    # -- reading and cutting

    def plan(self, values: tuple[int, ...]) -> tuple[tuple[Step, ...], Window | None]:
        """The plan and the window of a solution."""
        items = self.deadline.each(self.x.items())
        steps = tuple(sorted(Step(t, a) for (a, t), x in items if values[x]))
        if self.question.rule != WINDOW:
            return steps, None
        start = next(t for t, column in self.begins.items() if values[column])
        return steps, Window(start, next(t for t, column in self.ends.items() if values[column]))

    def told(self, state: frozenset[int]) -> frozenset[int]:
        """The state itself: the program has all facts."""
        return state

    def bound_suffix(self, xi2: int, state: frozenset[int], least: int | None) -> None:
        """A suffix from ``state`` at ``xi2`` adds at least ``least``; with None there is none."""
        self.model.family = "Def. 2.0a"
        differs: _Sum = {self.ends[xi2]: 1}
        true = 0
        for f in self.deadline.each(range(len(self.task.facts))):
            differs[self.y[f, xi2 - 1]] = 1 if f in state else -1
            true += f in state
        if least is None:
            self.model.add(differs, "<=", true)
            return
        prices = self.question.prices
        his = set(self.his)
        items = self.deadline.each(self.x.items())
        weights = {x: prices.team[a] + prices.talk[a] for (a, t), x in items if t >= xi2 and a in his}
        terms = {column: -least * c for column, c in differs.items()} | weights
        self.model.add(terms, ">=", -least * true)
