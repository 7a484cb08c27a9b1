"""The columns: arcs of the agents' networks, and the flows that they are.

An action is the sum of its arcs in the network of one of its participants; the others' sums are equal to it.
"""

from collections import defaultdict

from verify.programs.automata.linear import Sum
from verify.programs.automata.network import WAIT
from verify.programs.automata.setting import NetworkSetting
from verify.solvers.mip import Model


class Flows:
    """A flow through each agent's network (eq. 10).

    Attributes:
        columns: the column of each arc, by agent and layer.
        by_action: the arcs of each action, by agent and layer.
        inflow: the arcs into each node, by agent and layer.
        owner: the agent whose arcs stand for an action.
    """

    def __init__(self, model: Model, setting: NetworkSetting) -> None:
        """Add the columns, and their rows."""
        self.model = model
        self.setting = setting
        self.task = setting.task
        self.deadline = setting.deadline
        self.columns: list[list[list[int]]] = []
        self.by_action: list[list[dict[int, Sum]]] = []
        self.inflow: list[list[dict[int, Sum]]] = []
        self._flows()
        self._joint_actions()
        self.owner = {i: self._fewest_arcs(i) for i in self.deadline.each(setting.part.actions)}

    def _flows(self) -> None:
        for k, network in enumerate(self.setting.networks):
            self.model.family = f"eq. 10: {self.task.agents[k]}"
            columns, by_action, inflow = [], [], []
            before: dict[int, Sum] = {}
            for epoch, layer in enumerate(network.layers, start=1):
                numbers: list[int] = []
                sums: dict[int, Sum] = defaultdict(dict)
                into: dict[int, Sum] = defaultdict(dict)
                out: dict[int, Sum] = defaultdict(dict)
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

    def _conserve(self, k: int, epoch: int, into: dict[int, Sum], out: dict[int, Sum]) -> None:
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

    def action(self, i: int, epoch: int) -> Sum:
        """``x[i, epoch]`` as a sum of arcs."""
        return self.by_action[self.owner[i]][epoch - 1].get(i, {})

    def present(self, epoch: int) -> list[int]:
        """Actions with an arc in an epoch."""
        found: set[int] = set()
        for k in range(len(self.setting.networks)):
            found.update(i for i in self.by_action[k][epoch - 1] if i != WAIT and self.owner[i] == k)
        return sorted(found)
