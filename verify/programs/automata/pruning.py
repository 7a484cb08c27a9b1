"""Which arcs can lie on a plan that is cheap enough: reachability and least weights.

Everything here is a relaxation, so that what it drops is on no plan within the limit:

* forward: an arc needs a reachable source, facts that may be true (false) by then, and, for
  a joint action, an arc of the same action for each participant;
* least weights: the weight of a plan is the sum over its networks, so an arc is dropped if
  its own path and the least of the other networks pass the limit;
* help costs: a fact that only robots can provide costs at least the cheapest provider's path;
* usefulness: a robot that stops acting does so after an arc that somebody makes use of.
"""

from collections import defaultdict
from collections.abc import Container, Mapping, Sequence
from math import inf

from verify.programs.automata.forward import Forward
from verify.programs.automata.network import WAIT, Arc, actions_of
from verify.programs.automata.setting import NetworkSetting

MOST_ROUNDS = 6


def unroll(setting: NetworkSetting) -> bool:
    """Keep the arcs on paths from an agent's start to an end that may be possible, whatever they cost.

    A unit of flow in layers of arcs is made of such paths, so the rows say the same of what is dropped;
    what the arcs need may be true if nothing is ever deleted.
    """
    count = len(setting.bounds[0])
    setting.bounds = [0] * count, [0] * count
    forward = Forward(setting)
    forward.unroll()
    count = -1
    while count != (left := _arcs(setting)):
        count = left
        for k, network in enumerate(setting.networks):
            if network.open_end:
                _open_backward(setting, forward, k, -inf, range(1, setting.horizon + 1))
        forward.filter()
    setting.last = frozenset(ends(setting, forward, setting.task.human))
    return True


def _arcs(setting: NetworkSetting) -> int:
    return sum(len(layer) for network in setting.networks for layer in network.layers)


def prune(setting: NetworkSetting) -> bool:
    """Drop arcs from the networks' layers; False if no plan within the limit is left."""
    forward = Forward(setting)
    forward.unroll()
    count = -1
    for _ in range(MOST_ROUNDS):
        if not _least_weights(setting, forward):
            return False
        left = _arcs(setting)
        if left == count:
            return True
        count = left
        forward.filter()
    return _least_weights(setting, forward)


def _least_weights(setting: NetworkSetting, forward: Forward) -> bool:
    """One round of backward passes; False if the human has no path left."""
    human = setting.task.human
    robots = [k for k in range(len(setting.networks)) if k != human]
    provided = _Providers(setting, forward, robots)
    through = _human_backward(setting, forward, provided)
    if not through.cheapest < setting.far:
        return False
    for k in robots:
        if setting.networks[k].open_end:
            if not _open_backward(setting, forward, k, through.cheapest, through.active):
                return False
        else:
            _useful_backward(setting, forward, k, through)
    return True


class _Providers:
    """What help costs at least: robots' cheapest way to provide a fact or half of a joint action."""

    def __init__(self, setting: NetworkSetting, forward: Forward, robots: list[int]) -> None:
        self.setting = setting
        task = setting.task
        self.inside = frozenset().union(*(network.automaton.facts for network in setting.networks))
        self.true: dict[int, list[tuple[int, int]]] = defaultdict(list)
        self.false: dict[int, list[tuple[int, int]]] = defaultdict(list)
        self.joint: dict[tuple[int, int], list[int]] = {}
        self.his_true: set[int] = set()
        self.his_false: set[int] = set()
        for layer in setting.human.layers:
            for action in actions_of(layer, setting.deadline) - {WAIT}:
                self.his_true.update(task.actions[action].add)
                self.his_false.update(task.actions[action].delete)
        for k in robots:
            for epoch, layer in enumerate(setting.networks[k].layers, start=1):
                self._collect(epoch, layer, forward.reach[k][epoch - 1])

    def _collect(self, epoch: int, layer: list[Arc], before: dict[int, int]) -> None:
        cheapest: dict[int, int] = {}
        for source, _, action, weight, _ in self.setting.deadline.each(layer):
            if action != WAIT:
                total = before[source] + weight
                if total < cheapest.get(action, self.setting.far):
                    cheapest[action] = total
        for i, total in self.setting.deadline.each(cheapest.items()):
            ground = self.setting.task.actions[i]
            if len(ground.participants) > 1:
                self.joint.setdefault((i, epoch), []).append(total)
            for f in ground.add:
                self.true[f].append((epoch, total))
            for f in ground.delete:
                self.false[f].append((epoch, total))

    def surcharge(self, action: int, epoch: int, needs: frozenset[int]) -> int:
        """What robots must have spent for an arc of the human's to be possible in ``epoch``."""
        if action == WAIT and not needs:
            return 0
        init, inside = self.setting.task.init, self.inside
        most = 0
        pre = (*self.setting.outer_pre[action], *needs) if action != WAIT else tuple(needs)
        for f in pre:
            if f not in init and f not in inside and f not in self.his_true:
                most = max(most, _cheapest_before(self.true[f], epoch, self.setting.far))
        if action != WAIT:
            for f in self.setting.outer_neg[action]:
                if f in init and f not in inside and f not in self.his_false:
                    most = max(most, _cheapest_before(self.false[f], epoch, self.setting.far))
            most = max(most, sum(self.joint.get((action, epoch), ())))
        return most


def _cheapest_before(providers: list[tuple[int, int]], epoch: int, far: int) -> int:
    return min((total for when, total in providers if when < epoch), default=far)


class _Through:
    """Least weight of the human's paths, by what their arcs use."""

    def __init__(self, setting: NetworkSetting) -> None:
        self.setting = setting
        self.cheapest = self.far = setting.far
        self.true: dict[int, list[tuple[int, int]]] = defaultdict(list)
        self.false: dict[int, list[tuple[int, int]]] = defaultdict(list)
        self.joint: dict[tuple[int, int], int] = {}
        self.active: dict[int, int] = {}
        """By epoch: the least total with the epoch outside the suffix, so that robots may act."""

    def note(self, epoch: int, kept: Sequence[Arc], totals: Sequence[int]) -> None:
        """An epoch's arcs that are kept, each with the least weight of a path through it."""
        self.cheapest = min(totals, default=self.far)
        least: dict[tuple[int, frozenset[int]], int] = {}
        active, in_suffix = self.far, self.setting.human.in_suffix
        pairs = zip(kept, totals, strict=True)
        for (_, target, action, _, needs), total in self.setting.deadline.each(pairs):
            if total < least.get((action, needs), self.far):
                least[action, needs] = total
            if total < active and not in_suffix(target):
                active = total
        if active < self.far:
            self.active[epoch] = active
        for (action, needs), total in self.setting.deadline.each(least.items()):
            self._note_uses(action, epoch, needs, total)

    def _note_uses(self, action: int, epoch: int, needs: frozenset[int], total: int) -> None:
        for f in needs:
            self.true[f].append((epoch, total))
        if action == WAIT:
            return
        for f in self.setting.outer_pre[action]:
            self.true[f].append((epoch, total))
        for f in self.setting.outer_neg[action]:
            self.false[f].append((epoch, total))
        if len(self.setting.task.actions[action].participants) > 1:
            key = (action, epoch)
            self.joint[key] = min(total, self.joint.get(key, self.far))


def _human_backward(setting: NetworkSetting, forward: Forward, provided: _Providers) -> _Through:
    """The human's network, where robots add what they must have spent for an arc to be possible."""
    network, human = setting.human, setting.task.human
    through = _Through(setting)
    after = ends(setting, forward, human)
    for epoch in range(setting.horizon, 0, -1):
        reached = forward.reach[human][epoch - 1]
        surcharges: dict[tuple[int, frozenset[int]], int] = {}
        kept: list[Arc] = []
        totals: list[int] = []
        for arc in setting.deadline.each(network.layers[epoch - 1]):
            source, target, action, weight, needs = arc
            if target not in after:
                continue
            key = (action, needs)
            if key not in surcharges:
                surcharges[key] = provided.surcharge(action, epoch, needs)
            total = reached[source] + weight + after[target]  # the human's own path
            if total + surcharges[key] <= setting.most:
                kept.append(arc)
                totals.append(total)
        network.layers[epoch - 1] = kept
        through.note(epoch, kept, totals)
        if not kept:
            break
        after = _before(kept, after)
    return through


def _open_backward(
    setting: NetworkSetting, forward: Forward, k: int, others: float, active: Container[int]
) -> bool:
    """A network whose flow goes on to the end, beside what others cost at least; False if it can't."""
    network, robot = setting.networks[k], k not in setting.task.script.people
    after = ends(setting, forward, k)
    for epoch in range(setting.horizon, 0, -1):
        reached = forward.reach[k][epoch - 1]
        kept: list[Arc] = []
        for arc in setting.deadline.each(network.layers[epoch - 1]):
            source, target, action, weight, _ = arc
            if target not in after or (robot and action != WAIT and epoch not in active):
                continue
            if reached[source] + weight + after[target] + others <= setting.most:
                kept.append(arc)
        network.layers[epoch - 1] = kept
        after = _before(kept, after)
    return bool(after)


def ends(setting: NetworkSetting, forward: Forward, k: int) -> dict[int, int]:
    """Nodes in which a network's flow may end, with nothing left to pay."""
    network, finals = setting.networks[k], setting.finals[k]
    last = forward.reach[k][-1]
    return {node: 0 for node in last if network.state_of[node] in finals and network.ends(node)}


def _before(kept: Sequence[Arc], after: Mapping[int, int]) -> dict[int, int]:
    """Least weight from the nodes before an epoch to the end, along arcs that are kept."""
    before: dict[int, int] = {}
    for source, target, _, weight, _ in kept:
        rest = weight + after[target]
        before[source] = min(rest, before.get(source, rest))
    return before


def _useful_backward(setting: NetworkSetting, forward: Forward, k: int, through: _Through) -> None:
    """A robot that may stop anywhere: it does so after an arc of which somebody makes use."""
    network, use, far = setting.networks[k], _Use(setting, k, through), setting.far
    after: dict[int, int] = {}
    for epoch in range(setting.horizon, 0, -1):
        reached = forward.reach[k][epoch - 1]
        exits: dict[int, int] = {WAIT: far}
        active = through.active.get(epoch, far)
        kept: list[Arc] = []
        before: dict[int, int] = {}
        for arc in setting.deadline.each(network.layers[epoch - 1]):
            source, target, action, weight, _ = arc
            if action not in exits:
                exits[action] = max(use.least(action, epoch), active)
            rest = weight + min(exits[action], after.get(target, far))
            if reached[source] + rest <= setting.most and (action == WAIT or active < far):
                kept.append(arc)
                before[source] = min(rest, before.get(source, rest))
        network.layers[epoch - 1] = kept
        after = before


class _Use:
    """What it is worth that a robot acts: the human's least weight where somebody makes use of it."""

    def __init__(self, setting: NetworkSetting, k: int, through: _Through) -> None:
        self.setting = setting
        self.through = through
        self.true = _uses(setting, k, setting.wanted_true, setting.outer_pre)
        self.false = _uses(setting, k, setting.wanted_false, setting.outer_neg)

    def least(self, action: int, epoch: int) -> int:
        """Least weight of the human's path if an action of this epoch is made use of."""
        ground, through = self.setting.task.actions[action], self.through
        if len(ground.participants) > 1:
            with_human = self.setting.task.human in ground.participants
            return through.joint.get((action, epoch), through.far) if with_human else through.cheapest
        return min(
            _worth(ground.add, epoch, self.true, through.true, through),
            _worth(ground.delete, epoch, self.false, through.false, through),
        )


def _uses(
    setting: NetworkSetting, k: int, wanted: frozenset[int], outer: dict[int, tuple[int, ...]]
) -> set[int]:
    """Facts that a goal or another robot's surviving arcs look at: worth the human's least weight."""
    used = set(wanted)
    for other, network in enumerate(setting.networks):
        if other not in (k, setting.task.human):
            for layer in network.layers:
                for action in actions_of(layer, setting.deadline) - {WAIT}:
                    used.update(outer[action])
    return used


def _worth(
    facts: tuple[int, ...],
    epoch: int,
    used: set[int],
    by_human: dict[int, list[tuple[int, int]]],
    through: _Through,
) -> int:
    """Least weight of the human's path if one of the facts is made use of after ``epoch``."""
    best = through.far
    for f in facts:
        if f in used:
            return through.cheapest
        best = min(best, min((total for when, total in by_human.get(f, ()) if when > epoch), default=best))
    return best
