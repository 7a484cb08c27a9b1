"""The rows: flows in the agents' networks, shared facts, conflicts, limits.

Columns are arcs.  An action is the sum of its arcs in the network of one of its
participants; the others' sums are equal to it.  Shared facts follow value-transition flows
where an exactly-one group moves by precondition and delete only (van den Briel's
state-change family), else the exact frame, which negative preconditions need too.
"""

from collections import defaultdict
from collections.abc import Iterable
from typing import Final, NamedTuple

from serendipity.model import Condition, Step, Window
from verify.base.subproblem import Subproblem
from verify.programs.automata.control import INSIDE
from verify.programs.automata.network import WAIT
from verify.programs.automata.setting import Setting
from verify.solvers.mip import BYTES_A_TERM, Model, Terms

_Sum = dict[int, int]


class Linear(NamedTuple):
    """A linear expression: columns with their coefficients, and a constant."""

    terms: Terms
    constant: int = 0

    @property
    def is_zero(self) -> bool:
        """Whether it is 0 whatever the columns are."""
        return not self.terms and not self.constant


BYTES_AN_ARC: Final = 350 + 6 * BYTES_A_TERM
"""Memory for each arc of a program, from its column to its solution."""


class Program:
    """The integer program of a pruned setting."""

    def __init__(
        self, question: Subproblem, setting: Setting, groups: Iterable[frozenset[int]], *, complete: bool
    ) -> None:
        """With ``complete`` every relevant fact is represented, as ``suffixes.bound_suffix`` needs."""
        self.question = question
        self.setting = setting
        self.task = setting.task
        self.deadline = setting.deadline
        self.model = Model(self.deadline)
        self.columns: list[list[list[int]]] = []
        self.by_action: list[list[dict[int, _Sum]]] = []
        self.inflow: list[list[dict[int, _Sum]]] = []
        self.inside = {f: k for k, network in enumerate(setting.networks) for f in network.automaton.facts}
        self._flows()
        self._joint_actions()
        self.owner = {i: self._fewest_arcs(i) for i in self.deadline.each(setting.part.actions)}
        self.values: dict[int, list[Linear]] = {}
        self.frames: dict[int, list[int]] = {}
        shared = set(setting.part.facts) if complete else self._touched()
        for group in groups:
            if group & shared:
                self._value_flow(group)
        for f in sorted(shared - self.inside.keys() - self.values.keys()):
            self._frame(f)
        self._preconditions()
        self._needs()
        self._goals()
        self._conflicts()
        self._idle_robots()
        self._limits()

    # -- columns and flows

    def _flows(self) -> None:
        for k, network in enumerate(self.setting.networks):
            self.model.family = f"eq. 10: {self.task.agents[k]}"
            columns, by_action, inflow = [], [], []
            before: dict[int, _Sum] = {}
            for epoch, layer in enumerate(network.layers, start=1):
                numbers: list[int] = []
                sums: dict[int, _Sum] = defaultdict(dict)
                into: dict[int, _Sum] = defaultdict(dict)
                out: dict[int, _Sum] = defaultdict(dict)
                for source, target, action, weight, _ in layer:
                    x = self.model.binary()
                    if weight:
                        self.model.objective[x] = weight
                    numbers.append(x)
                    sums[action][x] = 1
                    into[target][x] = 1
                    out[source][x] = 1
                self._conserve(k, epoch, before, out)
                columns.append(numbers)
                by_action.append(dict(sums))
                inflow.append(dict(into))
                before = into
            self.columns.append(columns)
            self.by_action.append(by_action)
            self.inflow.append(inflow)

    def _conserve(self, k: int, epoch: int, into: dict[int, _Sum], out: dict[int, _Sum]) -> None:
        """What leaves a node came into it; an agent that may stop anywhere may leave less."""
        sense = "==" if self.setting.networks[k].open_end else "<="
        if epoch == 1:
            self.model.add(out[self.setting.networks[k].start], sense, 1)
            return
        for node in {**into, **out}:
            terms = dict(out.get(node, {}))
            for x in into.get(node, {}):
                terms[x] = terms.get(x, 0) - 1
            if sense == "==" or out.get(node):
                self.model.add(terms, sense, 0)

    def _joint_actions(self) -> None:
        """Every participant does its part of a joint action, or none does (eq. 10)."""
        self.model.family = "eq. 10: joint actions"
        for i in self.deadline.each(self.setting.part.actions):
            agents = self.task.actions[i].participants
            for t in range(self.setting.horizon) if len(agents) > 1 else ():
                first = self.by_action[agents[0]][t].get(i, {})
                for agent in agents[1:]:
                    other = self.by_action[agent][t].get(i, {})
                    if first or other:
                        self.model.add({**first, **dict.fromkeys(other, -1)}, "==", 0)

    def _fewest_arcs(self, i: int) -> int:
        """The participant in whose network an action has the fewest arcs."""
        return min(
            self.task.actions[i].participants,
            key=lambda agent: sum(len(layer.get(i, ())) for layer in self.by_action[agent]),
        )

    def action(self, i: int, epoch: int) -> _Sum:
        """``x[i, epoch]`` as a sum of arcs."""
        return self.by_action[self.owner[i]][epoch - 1].get(i, {})

    def present(self, epoch: int) -> list[int]:
        """Actions with an arc in an epoch."""
        found: set[int] = set()
        for k in range(len(self.setting.networks)):
            found.update(i for i in self.by_action[k][epoch - 1] if i != WAIT and self.owner[i] == k)
        return sorted(found)

    # -- shared facts

    def _touched(self) -> set[int]:
        """Facts whose truth some row has to refer to."""
        facts = set(self.setting.wanted_true | self.setting.wanted_false)
        for epoch in range(1, self.setting.horizon + 1):
            for i in self.deadline.each(self.present(epoch)):
                facts.update(self.setting.outer_pre[i], self.setting.outer_neg[i])
        return facts

    def _value_flow(self, group: frozenset[int]) -> None:
        """One unit of flow over the values of an exactly-one group; keeping a value is an arc."""
        self.model.family = "eq. 5, 6: values"
        for f in group:
            self.values[f] = [Linear({}, int(f in self.task.init))]
        for epoch in range(1, self.setting.horizon + 1):
            consumed, produced = self._transitions(group, epoch)
            for f in group:
                value = self._next_value(self.values[f][-1], consumed[f], produced[f])
                self.values[f].append(value)

    def _transitions(self, group: frozenset[int], epoch: int) -> tuple[dict[int, _Sum], dict[int, _Sum]]:
        """The actions that take a group's value away in an epoch, and those that bring it, by value."""
        consumed: dict[int, _Sum] = defaultdict(dict)
        produced: dict[int, _Sum] = defaultdict(dict)
        for i in self.deadline.each(self.present(epoch)):
            action = self.task.actions[i]
            for f in action.add:
                if f in group:
                    produced[f].update(self.action(i, epoch))
                    source = next(g for g in action.pre if g in group)
                    consumed[source].update(self.action(i, epoch))
        return consumed, produced

    def _next_value(self, before: Linear, consumed: _Sum, produced: _Sum) -> Linear:
        """A value after an epoch: what was there is taken away or kept, and what is brought comes to it."""
        if before.is_zero:
            if consumed:
                self.model.add(consumed, "==", 0)
            return Linear(produced)
        keep = self.model.column(0, 1, integral=False)
        balance = plus({**consumed, keep: 1}, before.terms, -1)
        self.model.add(balance, "==", before.constant)
        return Linear({**produced, keep: 1})

    def _frame(self, f: int) -> None:
        """The exact frame of one fact: (5) and (6) with their lower counterparts."""
        self.model.family = "eq. 5, 6: facts"
        model = self.model
        ys = [model.column(1, 1) if f in self.task.init else model.column(0, 0)]
        self.frames[f] = ys
        for epoch in range(1, self.setting.horizon + 1):
            y, before = model.column(0, 1, integral=False), ys[-1]
            ys.append(y)
            every_adder, adders, deleters = self._changers(f, epoch)
            model.add({y: 1, before: -1} | dict.fromkeys(every_adder, -1), "<=", 0)
            model.add({y: -1, before: 1} | dict.fromkeys(deleters, -1), "<=", 0)
            if deleters:
                model.add({y: 1, **deleters}, "<=", 1)
            for sums in adders.values():
                model.add({y: -1, **sums}, "<=", 0)

    def _changers(self, f: int, epoch: int) -> tuple[_Sum, dict[int, _Sum], _Sum]:
        """The actions that add a fact in an epoch, the same by agent, and those that delete it."""
        every_adder: _Sum = {}
        adders: dict[int, _Sum] = defaultdict(dict)
        deleters: _Sum = {}
        for i in self.deadline.each(self.present(epoch)):
            action = self.task.actions[i]
            if f in action.add:
                every_adder.update(self.action(i, epoch))
                for agent in action.participants:
                    adders[agent].update(self.action(i, epoch))
            if f in action.delete:
                deleters.update(self.action(i, epoch))
        return every_adder, adders, deleters

    def truth(self, f: int, epoch: int) -> Linear:
        """``y[f, epoch]``."""
        if f in self.inside:
            return self._truth_inside(self.inside[f], f, epoch)
        if f in self.values:
            return self.values[f][epoch]
        if f in self.frames:
            return Linear({self.frames[f][epoch]: 1})
        return Linear({}, int(f in self.task.init))

    def _truth_inside(self, k: int, f: int, epoch: int) -> Linear:
        """The same for a fact of an agent's automaton: the flow into the nodes in which it is true."""
        network = self.setting.networks[k]
        if epoch == 0:
            return Linear({}, int(f in network.true_facts(network.start)))
        sums: _Sum = {}
        for node, into in self.inflow[k][epoch - 1].items():
            if f in network.true_facts(node):
                sums.update(into)
        return Linear(sums)

    # -- what arcs need

    def _preconditions(self) -> None:
        """Eq. (4) for facts outside the participants' automata, summed over one agent's actions."""
        self.model.family = "eq. 4"
        for epoch in range(1, self.setting.horizon + 1):
            positive: dict[tuple[int, int], _Sum] = defaultdict(dict)
            negative: dict[tuple[int, int], _Sum] = defaultdict(dict)
            for i in self.deadline.each(self.present(epoch)):
                agent, action = self.owner[i], self.task.actions[i]
                for f in self.setting.outer_pre[i]:
                    if not (f in self.values and f in action.delete):
                        positive[agent, f].update(self.action(i, epoch))
                for f in self.setting.outer_neg[i]:
                    negative[agent, f].update(self.action(i, epoch))
            for (_, f), sums in positive.items():
                self._at_most(sums, self.truth(f, epoch - 1))
            for (_, f), sums in negative.items():
                terms, constant = self.truth(f, epoch - 1)
                self.model.add(plus(sums, terms), "<=", 1 - constant)

    def _at_most(self, sums: Terms, truth: Linear) -> None:
        self.model.add(plus(sums, truth.terms, -1), "<=", truth.constant)

    def _needs(self) -> None:
        """Facts that must hold where a suffix starts (preservation = state)."""
        self.model.family = "Def. 3.1"
        network, columns = self.setting.human, self.columns[self.task.human]
        for epoch, layer in enumerate(network.layers, start=1):
            wanted: dict[int, _Sum] = defaultdict(dict)
            for (*_, needs), x in zip(self.deadline.each(layer), columns[epoch - 1], strict=True):
                for f in needs:
                    wanted[f][x] = 1
            for f, sums in wanted.items():
                self._at_most(sums, self.truth(f, epoch - 1))

    def _goals(self) -> None:
        """Eq. (3), and what the last state must contain where the suffix is empty."""
        self.model.family = "eq. 3"
        last = self.setting.horizon
        inside = self.setting.human.automaton.facts
        robot_goal = self.task.robot_goal if self.question.robots_goal else Condition()
        for f in self.task.goal.positive + robot_goal.positive:
            if f in self.setting.part.facts and f not in inside:
                terms, constant = self.truth(f, last)
                self.model.add(terms, ">=", 1 - constant)
        for f in self.task.goal.negative + robot_goal.negative:
            if f in self.setting.part.facts and f not in inside:
                terms, constant = self.truth(f, last)
                self.model.add(terms, "<=", -constant)
        final = self.setting.last
        if final is not None:
            inflow = self.inflow[self.task.human][last - 1].items()
            self.model.add({x: 1 for node, into in inflow if node in final for x in into}, ">=", 1)
        for node, into in self.inflow[self.task.human][last - 1].items():
            choices = self.setting.human.ends(node)
            if frozenset() not in choices:
                for f in frozenset().union(*choices):  # one choice only, by construction
                    self._at_most(dict(into), self.truth(f, last))

    def _conflicts(self) -> None:
        """Eq. (5), (6): no fact is deleted twice, or added and deleted, by different actions."""
        self.model.family = "eq. 5, 6: conflicts"
        for epoch in range(1, self.setting.horizon + 1):
            deleters: dict[int, list[int]] = defaultdict(list)
            adders: dict[int, list[int]] = defaultdict(list)
            needers: dict[tuple[int, bool], list[int]] = defaultdict(list)
            for i in self.deadline.each(self.present(epoch)):
                action = self.task.actions[i]
                for f in action.delete:
                    deleters[f].append(i)
                for f in action.add:
                    adders[f].append(i)
                if self.question.options.strict:
                    for f in action.pre:
                        needers[f, True].append(i)
                    for f in action.neg:
                        needers[f, False].append(i)
            for f, ids in deleters.items():
                self._exclude(epoch, ids, adders.get(f, []))
            for (f, positive), ids in needers.items():
                against = deleters.get(f, []) if positive else adders.get(f, [])
                self._exclude_needs(epoch, ids, against)

    def _exclude(self, epoch: int, deleters: list[int], adders: list[int]) -> None:
        """An epoch has at most one deleter, and none beside an adder that is another action."""
        agents = {agent for i in (*deleters, *adders) for agent in self.task.actions[i].participants}
        common = set(agents)
        for i in (*deleters, *adders):
            common &= set(self.task.actions[i].participants)
        if common:
            return  # eq. (10) says it already
        every: _Sum = {}
        for i in deleters:
            every.update(self.action(i, epoch))
        for agent in sorted(agents):
            terms = dict(every)
            for i in adders:
                if agent in self.task.actions[i].participants:
                    terms.update(self.action(i, epoch))
            self.model.add(terms, "<=", 1)

    def _exclude_needs(self, epoch: int, needers: list[int], against: list[int]) -> None:
        """For-all-step semantics: nobody deletes or negates what another action needs."""
        for a in {self.owner[i] for i in needers}:
            mine: _Sum = {}
            for i in needers:
                if self.owner[i] == a:
                    mine.update(self.action(i, epoch))
            others: dict[int, _Sum] = defaultdict(dict)
            for i in against:
                if a not in self.task.actions[i].participants:
                    others[self.owner[i]].update(self.action(i, epoch))
            for sums in others.values():
                self.model.add({**mine, **sums}, "<=", 1)

    def _idle_robots(self) -> None:
        """Eq. (8), with joint actions: no robot acts in an epoch of the suffix."""
        self.model.family = "eq. 8"
        human = self.setting.human
        for epoch, layer in enumerate(human.layers, start=1):
            columns = self.columns[self.task.human][epoch - 1]
            free: _Sum = {}
            for (_, target, *_), x in zip(self.deadline.each(layer), columns, strict=True):
                if not human.in_suffix(target):
                    free[x] = -1
            if len(free) == len(layer):
                continue
            for k in range(len(self.setting.networks)):
                busy: _Sum = {}
                for i, sums in self.by_action[k][epoch - 1].items():
                    if i != WAIT and k != self.task.human:
                        busy.update(sums)
                if busy:
                    self.model.add({**busy, **free}, "<=", 0)

    def _limits(self) -> None:
        """The cut-off: nothing cheaper than the candidate (eq. 11)."""
        self.model.family = "eq. 11"
        question = self.question
        if question.most is not None and self.model.objective:
            self.model.add(dict(self.model.objective), "<=", question.most)
        if question.most_cost is not None:
            cost: _Sum = {}
            for epoch in range(1, question.horizon + 1):
                for i in self.deadline.each(self.present(epoch)):
                    if question.prices.team[i]:
                        cost.update(dict.fromkeys(self.action(i, epoch), question.prices.team[i]))
            if cost:
                self.model.add(cost, "<=", question.most_cost)

    # -- reading a solution

    def plan(self, values: tuple[int, ...]) -> tuple[tuple[Step, ...], Window | None]:
        """The plan and the window that the values stand for."""
        steps = []
        for epoch in range(1, self.question.horizon + 1):
            for i in self.deadline.each(self.present(epoch)):
                if any(values[x] for x in self.action(i, epoch)):
                    steps.append(Step(epoch, i))
        return tuple(steps), self._window(values)

    def _window(self, values: tuple[int, ...]) -> Window | None:
        if self.question.rule != "window":
            return None
        network = self.setting.human
        inside = []
        for epoch, layer in enumerate(network.layers, start=1):
            columns = self.columns[self.task.human][epoch - 1]
            for (_, target, *_), x in zip(self.deadline.each(layer), columns, strict=True):
                if values[x] and network.controls[target][0] == INSIDE:
                    inside.append(epoch)
        return Window(inside[0], inside[-1] + 1)


def plus(sums: Terms, more: Terms, factor: int = 1) -> _Sum:
    """A sum of columns, and ``factor`` times another.

    Args:
        sums: coefficients by column.
        more: those to add.
        factor: times this.
    """
    terms = dict(sums)
    for x, c in more.items():
        terms[x] = terms.get(x, 0) + factor * c
    return terms
