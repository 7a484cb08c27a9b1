"""Facts outside of automata as bits: who looks at them until when, what actions need and change of them."""

from collections.abc import Sequence
from dataclasses import dataclass

from serendipity.model import Deadline
from verify.base.execution import clash
from verify.programs.automata.network import WAIT
from verify.programs.automata.setting import NetworkSetting

STOPPED = -1
"""In the place of a robot's node: it does nothing any more."""

Nodes = Sequence[int]
"""The node of each agent's network, by id."""


@dataclass(frozen=True, slots=True)
class _Effect:
    """What an action needs and changes of shared facts, as bits, and needs of other agents' own facts."""

    pre: int
    neg: int
    add: int
    delete: int
    others: tuple[tuple[int, int, bool], ...]


class SharedFacts:
    """The shared facts of a pruned setting.

    Args:
        setting: pruned networks.
        strict: whether no action may falsify another's precondition.
        deadline: polled.

    Attributes:
        live: by epoch, the facts at which somebody looks after it, or a goal does, as bits.
    """

    def __init__(self, setting: NetworkSetting, deadline: Deadline, *, strict: bool) -> None:
        self._setting, self._task, self._deadline = setting, setting.task, deadline
        self._strict = strict
        self._inside = {f: k for k, net in enumerate(setting.networks) for f in net.automaton.facts}
        self._bits: dict[int, int] = {}
        self._effects: dict[int, _Effect] = {}
        self._clashes: dict[tuple[int, int], bool] = {}
        self._private: dict[tuple[int, int], bool] = {}
        self.live = self._live_facts()

    @property
    def initial(self) -> int:
        """Those that are true initially."""
        return self._mask([f for f in self._bits if f in self._task.init]) & self.live[0]

    def hold(self, action: int, nodes: Nodes, facts: int) -> bool:
        """Whether what an action needs outside its participants' automata is so."""
        if action == WAIT:
            return True
        effect = self._effect(action)
        if facts & effect.pre != effect.pre or facts & effect.neg:
            return False
        return all((f in self._own(k, nodes)) == wanted for k, f, wanted in effect.others)

    def true(self, needs: frozenset[int], nodes: Nodes, facts: int) -> bool:
        """Whether some facts are true, wherever they are kept."""
        for f in needs:
            k = self._inside.get(f)
            if k is None:
                if not self.has(facts, f):
                    return False
            elif f not in self._own(k, nodes):
                return False
        return True

    def has(self, facts: int, f: int) -> bool:
        """Whether a shared fact is true; one that nobody changes or looks at, initially."""
        return bool(facts >> self._bits[f] & 1) if f in self._bits else f in self._task.init

    def keeps(self, f: int) -> bool:
        """Whether a fact is among the shared ones."""
        return f in self._bits

    def after(self, epoch: int, facts: int, actions: Sequence[int]) -> int:
        """The facts after an epoch."""
        add = delete = 0
        for action in actions:
            effect = self._effect(action)
            add |= effect.add
            delete |= effect.delete
        return (facts & ~delete | add) & self.live[epoch]

    def clash(self, a: int, b: int) -> bool:
        """Whether two actions of different agents can't share an epoch."""
        key = (a, b) if a < b else (b, a)
        if key not in self._clashes:
            one, other = self._task.actions[a], self._task.actions[b]
            self._clashes[key] = clash(one, other, strict=self._strict) is not None
        return self._clashes[key]

    def noticed(self, action: int, epoch: int) -> bool:
        """Whether others can tell later that an action was done in an epoch."""
        effect = self._effect(action)
        together = len(self._task.actions[action].participants) > 1
        return together or bool((effect.add | effect.delete) & self.live[epoch])

    def is_private(self, k: int, action: int) -> bool:
        """Whether an action needs and changes nothing but facts of its agent's automaton."""
        if (k, action) not in self._private:
            ground, facts = self._task.actions[action], self._setting.networks[k].automaton.facts
            every = {*ground.pre, *ground.neg, *ground.add, *ground.delete}
            self._private[k, action] = len(ground.participants) == 1 and every <= facts
        return self._private[k, action]

    def unseen(self, k: int) -> bool:
        """Whether nobody else looks at what is true in an agent's automaton."""
        facts = self._setting.networks[k].automaton.facts
        for i in self._deadline.each(self._setting.part.actions):
            ground = self._task.actions[i]
            if k not in ground.participants and not facts.isdisjoint((*ground.pre, *ground.neg)):
                return False
        return True

    def _own(self, k: int, nodes: Nodes) -> frozenset[int]:
        assert nodes[k] != STOPPED, "nobody looks at the facts of robots that may stop"
        return self._setting.networks[k].true_facts(nodes[k])

    def _effect(self, action: int) -> _Effect:
        if action not in self._effects:
            ground = self._task.actions[action]
            pre, neg = self._setting.outer_pre[action], self._setting.outer_neg[action]
            others = [(self._inside[f], f, True) for f in pre if f in self._inside]
            others += [(self._inside[f], f, False) for f in neg if f in self._inside]
            needs, changes = (
                (self._mask(pre), self._mask(neg)),
                (self._mask(ground.add), self._mask(ground.delete)),
            )
            self._effects[action] = _Effect(*needs, *changes, tuple(others))
        return self._effects[action]

    def _mask(self, facts: Sequence[int]) -> int:
        return sum(1 << self._bits[f] for f in facts if f in self._bits)

    def _live_facts(self) -> list[int]:
        setting = self._setting
        live = [set(setting.wanted_true | setting.wanted_false)]
        for epoch in range(setting.horizon, 0, -1):
            looked = set(live[-1])
            for network in setting.networks:
                for _, _, action, _, needs in self._deadline.each(network.layers[epoch - 1]):
                    looked |= needs
                    if action != WAIT:
                        looked.update(setting.outer_pre[action], setting.outer_neg[action])
            live.append(looked)
        live.reverse()
        for f in sorted(live[0] - self._inside.keys()):
            self._bits[f] = len(self._bits)
        return [self._mask(sorted(facts)) for facts in live]
