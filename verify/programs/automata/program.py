"""The program: flows in the agents' networks, shared facts, and the rows that tie them together."""

from collections import defaultdict
from collections.abc import Iterable
from typing import Final

from serendipity.model import Step, Window
from verify.base.control import INSIDE
from verify.base.execution import is_last
from verify.base.subproblem import Subproblem
from verify.programs.automata.flows import Flows
from verify.programs.automata.linear import Linear, Sum, plus
from verify.programs.automata.network import WAIT
from verify.programs.automata.setting import NetworkSetting
from verify.programs.automata.shared_facts import SharedFacts
from verify.solvers.mip import BYTES_A_TERM, Model, Terms

BYTES_AN_ARC: Final = 350 + 6 * BYTES_A_TERM
"""Memory for each arc of a program, from its column to its solution."""


class NetworkProgram:
    """The integer program of a pruned setting."""

    def __init__(
        self,
        question: Subproblem,
        setting: NetworkSetting,
        groups: Iterable[frozenset[int]],
        shared: Model | None = None,
        *,
        complete: bool,
    ) -> None:
        """With ``complete`` every relevant fact is represented, as bounds on suffixes need.

        It becomes part of ``shared``, or one of its own.
        """
        self.question = question
        self.setting = setting
        self.task = setting.task
        self.deadline = setting.deadline
        self.model = shared or Model(self.deadline)
        self.flows = Flows(self.model, setting)
        self.facts = SharedFacts(self.flows, groups, set(setting.part.facts) if complete else self._touched())
        self._preconditions()
        self._needs()
        self._goals()
        self._conflicts()
        self._due()
        self._idle_robots()
        self._limits()

    def _touched(self) -> set[int]:
        """Facts whose truth some row has to refer to."""
        facts = set(self.setting.wanted_true | self.setting.wanted_false)
        facts.update(self.setting.part.facts & self.task.due_for.keys())
        for epoch in range(1, self.setting.horizon + 1):
            for i in self.deadline.each(self.flows.present(epoch)):
                facts.update(self.setting.outer_pre[i], self.setting.outer_neg[i])
        return facts

    # -- what arcs need

    def _preconditions(self) -> None:
        """Eq. (4) for facts outside the participants' automata, summed over one agent's actions."""
        self.model.family = "eq. 4"
        for epoch in range(1, self.setting.horizon + 1):
            positive: dict[tuple[int, int], Sum] = defaultdict(dict)
            negative: dict[tuple[int, int], Sum] = defaultdict(dict)
            for i in self.deadline.each(self.flows.present(epoch)):
                agent, action = self.flows.owner[i], self.task.actions[i]
                for f in self.setting.outer_pre[i]:
                    if not (f in self.facts.values and f in action.delete):
                        positive[agent, f].update(self.flows.action(i, epoch))
                for f in self.setting.outer_neg[i]:
                    negative[agent, f].update(self.flows.action(i, epoch))
            for (_, f), sums in positive.items():
                self._at_most(sums, self.facts.truth(f, epoch - 1))
            for (_, f), sums in negative.items():
                terms, constant = self.facts.truth(f, epoch - 1)
                self.model.add(plus(sums, terms), "<=", 1 - constant)

    def _at_most(self, sums: Terms, truth: Linear) -> None:
        self.model.add(plus(sums, truth.terms, -1), "<=", truth.constant)

    def _needs(self) -> None:
        """Facts that must hold where a suffix starts (preservation = state)."""
        self.model.family = "Def. 3.1"
        network, columns = self.setting.human, self.flows.columns[self.task.human]
        for epoch, layer in enumerate(network.layers, start=1):
            wanted: dict[int, Sum] = defaultdict(dict)
            for (*_, needs), x in zip(self.deadline.each(layer), columns[epoch - 1], strict=True):
                for f in needs:
                    wanted[f][x] = 1
            for f, sums in wanted.items():
                self._at_most(sums, self.facts.truth(f, epoch - 1))

    def _goals(self) -> None:
        """Eq. (3), and what the last state must contain where the suffix is empty."""
        self.model.family = "eq. 3"
        last = self.setting.horizon
        inside = self.setting.human.automaton.facts
        for f in self.question.goal.positive:
            if f in self.setting.part.facts and f not in inside:
                terms, constant = self.facts.truth(f, last)
                self.model.add(terms, ">=", 1 - constant)
        for f in self.question.goal.negative:
            if f in self.setting.part.facts and f not in inside:
                terms, constant = self.facts.truth(f, last)
                self.model.add(terms, "<=", -constant)
        final = self.setting.last
        if final is not None:
            inflow = self.flows.inflow[self.task.human][last - 1].items()
            self.model.add({x: 1 for node, into in inflow if node in final for x in into}, ">=", 1)
        for node, into in self.flows.inflow[self.task.human][last - 1].items():
            choices = self.setting.human.ends(node)
            if frozenset() not in choices:
                for f in frozenset().union(*choices):  # one choice only, by construction
                    self._at_most(dict(into), self.facts.truth(f, last))

    def _conflicts(self) -> None:
        """Eq. (5), (6): no fact is deleted twice, or added and deleted, by different actions."""
        self.model.family = "eq. 5, 6: conflicts"
        for epoch in range(1, self.setting.horizon + 1):
            deleters: dict[int, list[int]] = defaultdict(list)
            adders: dict[int, list[int]] = defaultdict(list)
            needers: dict[tuple[int, bool], list[int]] = defaultdict(list)
            for i in self.deadline.each(self.flows.present(epoch)):
                action = self.task.actions[i]
                if is_last(action):
                    continue
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

    def _due(self) -> None:
        """What is due takes place (semantics 10): ``x[o, t] >= s[f, t - 1]``, where no arc says so.

        An agent's automaton that has the fact has no arc of waiting where it is true.
        """
        self.model.family = "semantics 10"
        for f in sorted(self.setting.part.facts & self.task.due_for.keys()):
            inside = self.facts.is_inside(f)
            for variants in self.task.due_for[f]:
                if inside and f in self.task.actions[variants[0]].delete:
                    continue
                for epoch in range(1, self.setting.horizon + 1):
                    truth = self.facts.truth(f, epoch - 1)
                    if not truth.is_zero:
                        terms = dict(truth.terms)
                        for i in filter(self.flows.owner.__contains__, variants):
                            terms = plus(terms, self.flows.action(i, epoch), -1)
                        self.model.add(terms, "<=", -truth.constant)

    def _exclude(self, epoch: int, deleters: list[int], adders: list[int]) -> None:
        """An epoch has at most one deleter, and none beside an adder that is another action."""
        agents = {agent for i in (*deleters, *adders) for agent in self.task.actions[i].participants}
        common = set(agents)
        for i in (*deleters, *adders):
            common &= set(self.task.actions[i].participants)
        if common:
            return  # eq. (10) says it already
        every: Sum = {}
        for i in deleters:
            every.update(self.flows.action(i, epoch))
        for agent in sorted(agents):
            terms = dict(every)
            for i in adders:
                if agent in self.task.actions[i].participants:
                    terms.update(self.flows.action(i, epoch))
            self.model.add(terms, "<=", 1)

    def _exclude_needs(self, epoch: int, needers: list[int], against: list[int]) -> None:
        """For-all-step semantics: nobody deletes or negates what another action needs."""
        for a in {self.flows.owner[i] for i in needers}:
            mine: Sum = {}
            for i in needers:
                if self.flows.owner[i] == a:
                    mine.update(self.flows.action(i, epoch))
            others: dict[int, Sum] = defaultdict(dict)
            for i in against:
                if a not in self.task.actions[i].participants:
                    others[self.flows.owner[i]].update(self.flows.action(i, epoch))
            for sums in others.values():
                self.model.add({**mine, **sums}, "<=", 1)

    def _idle_robots(self) -> None:
        """Eq. (8), with joint actions: no robot acts in an epoch of the suffix."""
        self.model.family = "eq. 8"
        human = self.setting.human
        for epoch, layer in enumerate(human.layers, start=1):
            columns = self.flows.columns[self.task.human][epoch - 1]
            free: Sum = {}
            for (_, target, *_), x in zip(self.deadline.each(layer), columns, strict=True):
                if not human.in_suffix(target):
                    free[x] = -1
            if len(free) == len(layer):
                continue
            for k in range(len(self.setting.networks)):
                busy: Sum = {}
                for i, sums in self.flows.by_action[k][epoch - 1].items():
                    if i != WAIT and k != self.task.human and k not in self.task.script.people:
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
            cost: Sum = {}
            for epoch in range(1, question.horizon + 1):
                for i in self.deadline.each(self.flows.present(epoch)):
                    if question.prices.team[i]:
                        cost.update(dict.fromkeys(self.flows.action(i, epoch), question.prices.team[i]))
            if cost:
                self.model.add(cost, "<=", question.most_cost)

    # -- reading a solution

    def plan(self, values: tuple[int, ...]) -> tuple[tuple[Step, ...], Window | None]:
        """The plan and the window that the values stand for."""
        steps = []
        for epoch in range(1, self.question.horizon + 1):
            for i in self.deadline.each(self.flows.present(epoch)):
                if any(values[x] for x in self.flows.action(i, epoch)):
                    steps.append(Step(epoch, i))
        return tuple(steps), self._window(values)

    def _window(self, values: tuple[int, ...]) -> Window | None:
        if self.question.rule != "window":
            return None
        network = self.setting.human
        inside = []
        for epoch, layer in enumerate(network.layers, start=1):
            columns = self.flows.columns[self.task.human][epoch - 1]
            for (_, target, *_), x in zip(self.deadline.each(layer), columns, strict=True):
                if values[x] and network.controls[target][0] == INSIDE:
                    inside.append(epoch)
        return Window(inside[0], inside[-1] + 1)
