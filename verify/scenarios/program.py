"""All policies over scenarios as one program (semantics 11): a network for each of them, in which robots do
the same until they see the human do something different.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

from verify.base.control import PREFIX, Control, HumanControl, Leg
from verify.base.execution import unchosen
from verify.base.subproblem import IntegerPrices
from verify.calls.call import ExaminedCall
from verify.programs.automata import AutomataEncoding
from verify.programs.automata.linear import Sum, plus
from verify.programs.automata.program import NetworkProgram
from verify.programs.recorded import described, refuted
from verify.scenarios.measure import PARTS, Measure
from verify.solvers.model import Model


class _Control(HumanControl):
    """The rule of windows, by which a plan may be left alone, too: that counts as an epoch of one."""

    def legs(self, control: Control, epoch: int) -> Iterator[Leg]:
        for leg in super().legs(control, epoch):
            left_alone = leg.after[0] == PREFIX and epoch == self.question.horizon
            yield replace(leg, weight=self.question.prices.epoch) if left_alone else leg

    def accepts(self, control: Control) -> list[frozenset[int]]:
        return [frozenset()] if control[0] == PREFIX else super().accepts(control)


def refute_policies(calls: Sequence[ExaminedCall], measure: Measure, below: int) -> None:
    """Write down why no policy has a value below so much, or find it in the proof.

    Whatever a policy does is a solution of the program, of no greater value.

    Raises:
        UndecidedError: it could not be refuted, or the proof is of another one.
    """
    effort = calls[0].effort
    model, networks = Model(effort.deadline), list[NetworkProgram]()
    for call, share, ahead in zip(calls, measure.shares, measure.ahead, strict=True):
        team, first = tuple(map(measure.pay, call.prices.team)), len(model.upper)
        question = call.question.but(prices=IntegerPrices(0, team, call.prices.talk, measure.epoch))
        networks.append(AutomataEncoding(question, pruned=False, shared=model, control=_Control).program)
        own = {x: share * weight for x, weight in model.objective.items() if x >= first}
        model.objective.update(own)
        if not measure.is_mean:  # the sum of them guides whoever looks for a proof
            model.family = "semantics 11: the greatest counts"
            model.add(own, "<=", below - 1 - ahead)
    for one, other in combinations(networks, 2):
        _tell_apart(model, one, other)
    name = f"all policies over {len(calls)} scenarios, {calls[0].horizon} epochs"
    name += f", probabilities in parts of {PARTS}" if measure.slack else ""
    limit = below - 1 if measure.is_mean else len(calls) * (below - 1) - sum(measure.ahead)
    assert effort.proof is not None, "nobody else asks"
    refuted(effort.proof, described(name, 0, model, effort.deadline), model, limit, effort.deadline)


def _tell_apart(model: Model, one: NetworkProgram, other: NetworkProgram) -> None:
    """Robots do the same in two scenarios until they have seen the human do something different."""
    apart, options = Sum(), one.question.options
    for epoch in range(1, one.question.horizon + 1):
        (own, his), (others, theirs) = _begun(one, epoch), _begun(other, epoch)
        model.family = "semantics 11: robots"
        for name in own | others:
            more = plus(own.get(name, {}), others.get(name, {}), -1)
            model.add(plus(more, apart, -1), "<=", 0)
            model.add(plus(more, apart), ">=", 0)
        if options.policy == "watching":
            model.family = "semantics 11: what is seen"
            different, later = model.binary(), model.binary()
            for name in [name for name in his if name in theirs]:
                model.add({different: 1, **his[name], **theirs[name]}, "<=", 2)
            begun = (x for sums in (*his.values(), *theirs.values()) for x in sums)
            model.add({different: 1, **dict.fromkeys(begun, -1)}, "<=", 0)
            model.add(plus({later: 1, different: -1}, apart, -1), "<=", 0)
            apart = {later: 1}


def _begun(program: NetworkProgram, epoch: int) -> tuple[dict[object, Sum], dict[object, Sum]]:
    """What robots begin by themselves in an epoch, and what the human does, by name and participants."""
    task, found = program.task, (defaultdict[object, Sum](dict), defaultdict[object, Sum](dict))
    nobody = unchosen(task).union(task.of_bystanders)
    for i in program.flows.present(epoch):
        action = task.actions[i]
        if i not in nobody:
            sums = found[task.human in action.participants][action.name, action.participants]
            sums.update(program.flows.action(i, epoch))
    return found
