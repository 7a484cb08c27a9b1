"""Facts that several agents share: what is true of them after each epoch.

They follow value-transition flows where an exactly-one group moves by precondition and delete only
(van den Briel's state-change family), else the exact frame, which negative preconditions need too.
"""

from collections import defaultdict
from collections.abc import Iterable

from verify.base.execution import is_last
from verify.programs.automata.flows import Flows
from verify.programs.automata.linear import Linear, Sum, plus


class SharedFacts:
    """The truth of facts, as linear expressions (eq. 5, 6).

    Attributes:
        values: those that are values of a group.
    """

    def __init__(self, flows: Flows, groups: Iterable[frozenset[int]], shared: set[int]) -> None:
        """Add the rows of facts.

        Args:
            groups: facts of which exactly one is true, and moves by precondition and delete.
            shared: facts that need rows.
        """
        self._flows = flows
        self._model, self._setting = flows.model, flows.setting
        self._task, self._deadline = flows.task, flows.deadline
        networks = enumerate(self._setting.networks)
        self._inside = {f: k for k, network in networks for f in network.automaton.facts}
        self.values: dict[int, list[Linear]] = {}
        self._frames: dict[int, list[int]] = {}
        for group in groups:
            if group & shared:
                self._value_flow(group)
        for f in sorted(shared - self._inside.keys() - self.values.keys()):
            self._frame(f)

    def _value_flow(self, group: frozenset[int]) -> None:
        """One unit of flow over the values of an exactly-one group; keeping a value is an arc."""
        self._model.family = "eq. 5, 6: values"
        for f in group:
            self.values[f] = [Linear({}, int(f in self._task.init))]
        for epoch in range(1, self._setting.horizon + 1):
            consumed, produced = self._transitions(group, epoch)
            for f in group:
                value = self._next_value(self.values[f][-1], consumed[f], produced[f])
                self.values[f].append(value)

    def _transitions(self, group: frozenset[int], epoch: int) -> tuple[dict[int, Sum], dict[int, Sum]]:
        """The actions that take a group's value away in an epoch, and those that bring it, by value."""
        consumed: dict[int, Sum] = defaultdict(dict)
        produced: dict[int, Sum] = defaultdict(dict)
        for i in self._deadline.each(self._flows.present(epoch)):
            action = self._task.actions[i]
            for f in action.add:
                if f in group:
                    produced[f].update(self._flows.action(i, epoch))
                    source = next(g for g in action.pre if g in group)
                    consumed[source].update(self._flows.action(i, epoch))
        return consumed, produced

    def _next_value(self, before: Linear, consumed: Sum, produced: Sum) -> Linear:
        """A value after an epoch: what was there is taken away or kept, and what is brought comes to it."""
        if before.is_zero:
            if consumed:
                self._model.add(consumed, "==", 0)
            return Linear(produced)
        keep = self._model.column(0, 1, integral=False)
        balance = plus({**consumed, keep: 1}, before.terms, -1)
        self._model.add(balance, "==", before.constant)
        return Linear({**produced, keep: 1})

    def is_inside(self, f: int) -> bool:
        """Whether a fact is one of an agent's automaton."""
        return f in self._inside

    def _scripted(self, f: int, epoch: int) -> bool | None:
        """The truth that the script gives a fact with an epoch, last of all; None: it does not change it."""
        for i in self._flows.present(epoch) if self._task.of_bystanders else ():
            action = self._task.actions[i]
            if is_last(action) and f in (*action.add, *action.delete):
                return f in action.add
        return None

    def _frame(self, f: int) -> None:
        """The exact frame of one fact: (5) and (6) with their lower counterparts."""
        self._model.family = "eq. 5, 6: facts"
        model = self._model
        ys = [model.column(1, 1) if f in self._task.init else model.column(0, 0)]
        self._frames[f] = ys
        for epoch in range(1, self._setting.horizon + 1):
            fixed = self._scripted(f, epoch)
            if fixed is not None:
                ys.append(model.column(int(fixed), int(fixed)))
                continue
            y, before = model.column(0, 1, integral=False), ys[-1]
            ys.append(y)
            every_adder, adders, deleters = self._changers(f, epoch)
            model.add({y: 1, before: -1} | dict.fromkeys(every_adder, -1), "<=", 0)
            model.add({y: -1, before: 1} | dict.fromkeys(deleters, -1), "<=", 0)
            if deleters:
                model.add({y: 1, **deleters}, "<=", 1)
            for sums in adders.values():
                model.add({y: -1, **sums}, "<=", 0)

    def _changers(self, f: int, epoch: int) -> tuple[Sum, dict[int, Sum], Sum]:
        """The actions that add a fact in an epoch, the same by agent, and those that delete it."""
        every_adder: Sum = {}
        adders: dict[int, Sum] = defaultdict(dict)
        deleters: Sum = {}
        for i in self._deadline.each(self._flows.present(epoch)):
            action = self._task.actions[i]
            if f in action.add:
                every_adder.update(self._flows.action(i, epoch))
                for agent in action.participants:
                    adders[agent].update(self._flows.action(i, epoch))
            if f in action.delete:
                deleters.update(self._flows.action(i, epoch))
        return every_adder, adders, deleters

    def truth(self, f: int, epoch: int) -> Linear:
        """``y[f, epoch]``."""
        if f in self._inside:
            return self._truth_inside(self._inside[f], f, epoch)
        if f in self.values:
            return self.values[f][epoch]
        if f in self._frames:
            return Linear({self._frames[f][epoch]: 1})
        return Linear({}, int(f in self._task.init))

    def _truth_inside(self, k: int, f: int, epoch: int) -> Linear:
        """The same for a fact of an agent's automaton: the flow into the nodes in which it is true."""
        network = self._setting.networks[k]
        if epoch == 0:
            return Linear({}, int(f in network.true_facts(network.start)))
        sums: Sum = {}
        for node, into in self._flows.inflow[k][epoch - 1].items():
            if f in network.true_facts(node):
                sums.update(into)
        return Linear(sums)
