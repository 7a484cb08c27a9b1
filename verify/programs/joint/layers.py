"""All joint paths through the networks that pruning leaves: dynamic programming, epoch by epoch.

A joint state is a node of each agent's network and the shared facts that somebody still looks at.  Each is
kept at its least cost, and left out if that and what is left at least pass the limit: the human's least
weight to an end, and for each robot that goes on what it takes until it does something that others can
notice.
A robot that does nothing more is nowhere: since nobody looks at its own facts again, that is one state for
all places.

Where waiting costs nothing, a joint state that was there in an earlier epoch at no higher cost is left out:
who is early can wait, and do the rest as much earlier.  And nobody waits before an action that is nobody
else's business: it needs and changes nothing but the agent's own facts, at which nobody else looks, so that
it can as well be done before the wait.  Neither makes a plan dearer, so that pruning, which keeps all plans
within the limit, has kept those as well.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from serendipity.model import Deadline, Step, Window
from verify.base.subproblem import FREE, WINDOW, Subproblem
from verify.limits import limits
from verify.programs.automata.control import INSIDE
from verify.programs.automata.network import WAIT, Arc
from verify.programs.automata.setting import NetworkSetting
from verify.programs.joint.shared import STOPPED, SharedFacts

_Joint = tuple[int, ...]
"""Nodes of all agents by id, those who have waited as bits, and the shared facts as bits."""


_Layer = dict[_Joint, int]
"""What was paid for each joint state."""


class JointPathsError(Exception):
    """There are too many joint states."""


@dataclass(frozen=True, slots=True)
class JointPath:
    """A cheapest joint path.

    Attributes:
        steps: what is done.
        window: the human's window, or None.
        weight: the objective in units.
    """

    steps: tuple[Step, ...]
    window: Window | None
    weight: int


@dataclass(frozen=True, slots=True)
class _Chosen:
    """What some agents do in an epoch: nodes afterwards, weight, actions, who is needed, who has waited."""

    nodes: list[int]
    weight: int
    actions: tuple[int, ...]
    required: dict[int, int]
    waited: int


class JointLayers:
    """The search.

    Args:
        question: what is asked; a limit on cost beside that on the objective is not looked at.
        setting: pruned networks.
        deadline: polled.

    Attributes:
        states: how many were kept.
    """

    def __init__(self, question: Subproblem, setting: NetworkSetting, deadline: Deadline) -> None:
        self._question, self._setting = question, setting
        self._task, self._human = setting.task, setting.task.human
        self._deadline = deadline
        conditions = [self._task.goal, *([self._task.robot_goal] if question.robots_goal else [])]
        self._goals = {f: True for each in conditions for f in each.positive}
        self._goals |= {f: False for each in conditions for f in each.negative}
        self._shared = SharedFacts(setting, deadline, strict=question.options.strict)
        self._arcs = [self._by_source(k) for k in range(len(setting.networks))]
        self._left = [self._least_left(k) for k in range(len(setting.networks))]
        self._hurries = [self._shared.unseen(k) for k in range(len(setting.networks))]
        self._parents: list[dict[_Joint, tuple[_Joint, tuple[int, ...]]]] = []
        self.states = 0

    def run(self) -> JointPath | None:
        """A cheapest joint path within the limit; None: there is none.

        Raises:
            JointPathsError: it would take too many joint states.
            LimitReachedError: the deadline came first.
        """
        layer = self._first()
        best: dict[_Joint, int] = {}
        for epoch in range(1, self._setting.horizon + 1):
            following: _Layer = {}
            parents: dict[_Joint, tuple[_Joint, tuple[int, ...]]] = {}
            for joint, paid in layer.items():
                self._deadline.tick()
                for after, weight, actions in self._successors(epoch, joint):
                    total = paid + weight
                    if total < following.get(after, total + 1) and self._hopeful(epoch, after, total):
                        following[after] = total
                        parents[after] = joint, actions
                if self.states + len(following) > limits().joint_paths:
                    raise JointPathsError
            layer = self._improved(following, best)
            self.states += len(layer)
            self._parents.append(parents)
        ends = {joint: paid for joint, paid in layer.items() if self._may_end(joint)}
        if not ends:
            return None
        last = min(ends, key=lambda joint: (ends[joint], joint))
        return self._path(last, ends[last])

    # -- layers

    def _first(self) -> _Layer:
        facts = self._shared.initial
        layer: list[tuple[int, ...]] = [()]
        for network in self._setting.networks:
            choices = (network.start,) if network.open_end else (network.start, STOPPED)
            layer = [(*nodes, node) for nodes in layer for node in choices]
        joints = ((*nodes, 0, facts) for nodes in layer)
        return {joint: 0 for joint in joints if self._hopeful(0, joint, 0)}

    def _improved(self, layer: _Layer, best: dict[_Joint, int]) -> _Layer:
        """The joint states of a layer that no earlier epoch had at no higher cost."""
        kept: _Layer = {}
        for joint, paid in layer.items():
            if self._may_wait(joint):
                known = (best[other] for other in _less_waited(joint) if other in best)
                if paid >= min(known, default=paid + 1) and not self._may_end(joint):
                    continue
                best[joint] = min(paid, best.get(joint, paid))
            kept[joint] = paid
        return kept

    def _may_wait(self, joint: _Joint) -> bool:
        """Whether everybody may wait in a joint state, any number of epochs, for nothing."""
        return self._freely(joint[self._human])

    def _freely(self, node: int) -> bool:
        """Whether the human may wait in a node, any number of epochs, for nothing."""
        if self._question.rule == FREE:
            return True
        human = self._setting.human
        inside = human.controls[node][0] == INSIDE
        free = not self._question.prices.epoch and not human.control.counted
        literal = self._question.options.preservation == "state"
        return self._question.rule == WINDOW and inside and free and not literal

    def _hopeful(self, epoch: int, joint: _Joint, paid: int) -> bool:
        """Whether a joint state may be on a path within the limit, by what was paid."""
        for k, node in enumerate(joint[:-2]):
            if node != STOPPED:
                left = self._left[k][epoch].get(node)
                if left is None:
                    return False
                paid += left
        return paid <= self._setting.most

    # -- one epoch

    def _successors(self, epoch: int, joint: _Joint) -> Iterator[tuple[_Joint, int, tuple[int, ...]]]:
        """The joint states after an epoch, what it weighs, and its actions."""
        facts, waited = joint[-1], joint[-2]
        human = self._setting.human
        for arc in self._arcs[self._human][epoch - 1].get(joint[self._human], ()):
            source, target, action, weight, needs = arc
            after = waited
            if self._hurries[self._human] and not needs and self._freely(source) and self._freely(target):
                after = self._waits(self._human, action, waited)
            if (
                after < 0
                or not self._shared.hold(action, joint, facts)
                or not self._shared.true(needs, joint, facts)
            ):
                continue
            nodes = list(joint[:-2])
            nodes[self._human] = target
            acting = () if action == WAIT else (action,)
            required = dict.fromkeys(self._partners(action, self._human), action)
            chosen = _Chosen(nodes, weight, acting, required, after)
            for all_chosen in self._robots(epoch, joint, 0, chosen, idle=human.in_suffix(target)):
                state = self._shared.after(epoch, facts, all_chosen.actions)
                together = (*all_chosen.nodes, all_chosen.waited, state)
                yield together, all_chosen.weight, all_chosen.actions

    def _waits(self, k: int, action: int, waited: int) -> int:
        """Who has waited, after an agent has done an action or waits; -1: it could have been done before."""
        if action == WAIT:
            return waited | 1 << k
        if waited >> k & 1 and self._shared.is_private(k, action):
            return -1
        return waited & ~(1 << k)

    def _robots(self, epoch: int, joint: _Joint, k: int, chosen: _Chosen, *, idle: bool) -> Iterator[_Chosen]:
        """What the agents from ``k`` on may do beside those who have chosen."""
        nodes, required = chosen.nodes, chosen.required
        if k == len(nodes):
            yield chosen
            return
        if k == self._human:
            yield from self._robots(epoch, joint, k + 1, chosen, idle=idle)
            return
        if nodes[k] == STOPPED:
            if k not in required:
                yield from self._robots(epoch, joint, k + 1, chosen, idle=idle)
            return
        for _, target, action, more, _ in self._arcs[k][epoch - 1].get(nodes[k], ()):
            waited = self._waits(k, action, chosen.waited) if self._hurries[k] else chosen.waited
            beside = self._beside(joint, k, action, chosen, idle=idle)
            if waited < 0 or beside is None:
                continue
            acting, wanted = beside
            ends = [target] if target in self._left[k][epoch] else []
            if action != WAIT and not self._setting.networks[k].open_end:
                ends.append(STOPPED)
            for end in ends:
                after = [*nodes]
                after[k] = end
                now = waited & ~(1 << k) if end == STOPPED else waited
                following = _Chosen(after, chosen.weight + more, acting, wanted, now)
                yield from self._robots(epoch, joint, k + 1, following, idle=idle)

    def _beside(
        self, joint: _Joint, k: int, action: int, chosen: _Chosen, *, idle: bool
    ) -> tuple[tuple[int, ...], dict[int, int]] | None:
        """All actions, and who has to take part in which, with a robot's; None: it does not fit."""
        required = chosen.required
        if k in required:
            return (chosen.actions, required) if action == required[k] else None
        if action == WAIT:
            return chosen.actions, required
        partners = self._partners(action, k)
        if idle or any(j < k or j == self._human or j in required for j in partners):
            return None
        if not self._shared.hold(action, joint, joint[-1]):
            return None
        if any(self._shared.clash(action, other) for other in chosen.actions):
            return None
        wanted = {**required, **dict.fromkeys(partners, action)} if partners else required
        return (*chosen.actions, action), wanted

    def _partners(self, action: int, agent: int) -> list[int]:
        if action == WAIT:
            return []
        return [j for j in self._task.actions[action].participants if j != agent]

    # -- ends

    def _may_end(self, joint: _Joint) -> bool:
        setting, facts = self._setting, joint[-1]
        for k, node in enumerate(joint[:-2]):
            network = setting.networks[k]
            if node != STOPPED and network.open_end and network.state_of[node] not in setting.finals[k]:
                return False
        for f, wanted in self._goals.items():
            if self._shared.keeps(f) and self._shared.has(facts, f) != wanted:
                return False
        choices = setting.human.ends(joint[self._human])
        return any(self._shared.true(needs, joint, facts) for needs in choices)

    # -- what is prepared

    def _by_source(self, k: int) -> list[dict[int, list[Arc]]]:
        found: list[dict[int, list[Arc]]] = []
        for layer in self._setting.networks[k].layers:
            arcs: dict[int, list[Arc]] = {}
            for arc in self._deadline.each(layer):
                arcs.setdefault(arc[0], []).append(arc)
            found.append(arcs)
        return found

    def _least_left(self, k: int) -> list[dict[int, int]]:
        """By epoch and node, what an agent has to pay afterwards at least; a missing node leads nowhere."""
        setting, network = self._setting, self._setting.networks[k]
        after: dict[int, int] = {}
        if network.open_end:
            nodes = {arc[1] for arc in network.layers[-1]} or {network.start}
            after = {node: 0 for node in nodes if network.state_of[node] in setting.finals[k]}
        found = [after]
        for epoch in range(setting.horizon, 0, -1):
            before: dict[int, int] = {}
            for source, target, action, weight, _ in self._deadline.each(network.layers[epoch - 1]):
                rest = after.get(target)
                if not network.open_end and action != WAIT and self._shared.noticed(action, epoch):
                    rest = 0
                if rest is not None:
                    before[source] = min(weight + rest, before.get(source, weight + rest))
            found.append(before)
            after = before
        found.reverse()
        return found

    # -- reading a path

    def _path(self, joint: _Joint, weight: int) -> JointPath:
        steps: list[Step] = []
        inside: list[int] = []
        human = self._setting.human
        for epoch in range(self._setting.horizon, 0, -1):
            if human.controls[joint[self._human]][0] == INSIDE:
                inside.append(epoch)
            joint, actions = self._parents[epoch - 1][joint]
            steps += [Step(epoch, action) for action in actions]
        window = Window(inside[-1], inside[0] + 1) if self._question.rule == WINDOW and inside else None
        return JointPath(tuple(sorted(steps)), window, weight)


def _less_waited(joint: _Joint) -> Iterator[_Joint]:
    """The joint states in which no more agents have waited: what is left can go on from them as well."""
    *nodes, waited, facts = joint
    fewer = waited
    while True:
        yield (*nodes, fewer, facts)
        if not fewer:
            return
        fewer = (fewer - 1) & waited
