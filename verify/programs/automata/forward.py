"""Reachability from ``I``: an arc needs a reachable source, facts that may be true (false) by
then, and, for a joint action, an arc of the same action for each participant.
"""

from collections.abc import Callable
from typing import Final

from verify.programs.automata.network import ACTION, WAIT, Arc, actions_of
from verify.programs.automata.setting import NetworkSetting

_MANY: Final = 50_000
"""Arcs of an epoch from which on there may be no memory for those of the next one."""

_BYTES_AN_ARC: Final = 150


class Forward:
    """Layers of arcs, epoch by epoch, over all networks at once.

    Attributes:
        reach: by network and epoch, the reachable nodes with their least weight so far.
    """

    def __init__(self, setting: NetworkSetting) -> None:
        self.setting = setting
        self.deadline = setting.deadline
        self.reach: list[list[dict[int, int]]] = []
        self.watched = self._watched()

    def _watched(self) -> list[frozenset[int]]:
        """Facts of each automaton that others' actions, or nobody's own action, look at."""
        looked = set(self.setting.wanted_true | self.setting.wanted_false)
        for facts in (*self.setting.outer_pre.values(), *self.setting.outer_neg.values()):
            looked.update(facts)
        return [network.automaton.facts & looked for network in self.setting.networks]

    def unroll(self) -> None:
        """Build all layers."""
        networks = self.setting.networks
        for network in networks:
            network.layers = [[] for _ in range(self.setting.horizon)]
        self._pass(fresh=True)

    def filter(self) -> None:
        """Keep the arcs that are still reachable."""
        self._pass(fresh=False)

    def _pass(self, *, fresh: bool) -> None:
        setting = self.setting
        self.true = set(setting.task.init)
        self.false = set(setting.part.facts) - setting.task.init
        self.reach = [[{network.start: 0}] for network in setting.networks]
        for epoch in range(1, setting.horizon + 1):
            candidates = [self._candidates(k, epoch, fresh=fresh) for k in range(len(setting.networks))]
            blocked = self._one_sided(candidates)
            for k, arcs in enumerate(candidates):
                kept = [arc for arc in arcs if arc[ACTION] not in blocked] if blocked else arcs
                self._advance(k, epoch, kept)
            self._learn(epoch)

    def _candidates(self, k: int, epoch: int, *, fresh: bool) -> list[Arc]:
        setting, network = self.setting, self.setting.networks[k]
        reached = self.reach[k][-1]
        usable = self._usable_now()
        found: list[Arc] = []
        if not fresh:
            for arc in self.deadline.each(network.layers[epoch - 1]):
                source, _, action, _, needs = arc
                if source in reached and usable(action) and needs <= self.true:
                    found.append(arc)
            return found
        if k != setting.task.human:
            nodes = self.deadline.each(reached)
            return [arc for node in nodes for arc in network.outgoing(node, epoch) if usable(arc[ACTION])]
        weights, actions = setting.bounds
        left = setting.horizon - epoch
        for node, done in reached.items():
            self.deadline.check()
            for arc in network.outgoing(node, epoch):
                _, target, action, weight, needs = arc
                state = network.state_of[target]
                left_to_do, left_to_pay = actions[state], weights[state]
                if left_to_do is None or left_to_pay is None:
                    continue
                in_reach = left_to_do <= left and done + weight + left_to_pay <= setting.most
                if in_reach and usable(action) and needs <= self.true:
                    found.append(arc)
        return found

    def _usable_now(self) -> Callable[[int], bool]:
        known: dict[int, bool] = {WAIT: True}
        pre, neg, true, false = self.setting.outer_pre, self.setting.outer_neg, self.true, self.false

        def usable(action: int) -> bool:
            if action not in known:
                known[action] = all(f in true for f in pre[action]) and all(f in false for f in neg[action])
            return known[action]

        return usable

    def _one_sided(self, candidates: list[list[Arc]]) -> set[int]:
        """Joint actions for which a participant has no arc."""
        present = [actions_of(arcs, self.deadline) for arcs in candidates]
        blocked = set()
        for actions in present:
            for i in self.deadline.each(actions):
                if i != WAIT:
                    participants = self.setting.task.actions[i].participants
                    if len(participants) > 1 and not all(i in present[agent] for agent in participants):
                        blocked.add(i)
        return blocked

    def _advance(self, k: int, epoch: int, arcs: list[Arc]) -> None:
        if len(arcs) > _MANY:
            self.deadline.require(len(arcs) * _BYTES_AN_ARC)
        before = self.reach[k][-1]
        reached: dict[int, int] = {}
        far = self.setting.far
        for source, target, _, weight, _ in self.deadline.each(arcs):
            total = before[source] + weight
            if total < reached.get(target, far):
                reached[target] = total
        self.setting.networks[k].layers[epoch - 1] = arcs
        self.reach[k].append(reached)

    def _learn(self, epoch: int) -> None:
        """Facts that may be true, or false, after the epoch."""
        setting = self.setting
        for k, network in enumerate(setting.networks):
            for action in actions_of(network.layers[epoch - 1], self.deadline) - {WAIT}:
                self.true.update(setting.task.actions[action].add)
                self.false.update(setting.task.actions[action].delete)
            watched = self.watched[k]
            if watched:
                for node in self.deadline.each(self.reach[k][-1]):
                    facts = network.true_facts(node)
                    self.true |= watched & facts
                    self.false |= watched - facts
