"""The human's control automaton, one for each rule: which actions they may do in which epoch.

A control state is a short text-and-numbers tuple; the first entry says in which part of
the plan an epoch lies: ``prefix``, ``window`` or ``suffix`` (semantics 3.1), or ``free``.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, partial
from itertools import islice

from verify.base.due import turns
from verify.base.execution import facts_of_his, idling, states_of_pi_h
from verify.base.subproblem import ALONE, EXACT, FREE, WINDOW, Subproblem, in_plan

Control = tuple[str, int, int]

PREFIX, INSIDE, SUFFIX, ANY = "prefix", "window", "suffix", "free"

ALL, OWN = "all", "own"


@dataclass(frozen=True, slots=True)
class Leg:
    """One way to spend an epoch.

    Attributes:
        after: control state of this epoch, from which the next one goes on.
        actions: ids that the human may do, or ``all`` or ``own``.
        wait: whether they may do nothing.
        weight: units that the epoch adds to the objective (``K`` inside the window).
        needs: facts that must be true before the epoch (Def. 3.1 read literally).
        free: whether waiting is free even where it costs: nothing is begun any more.
    """

    after: Control
    actions: tuple[int, ...] | str
    wait: bool = True
    weight: int = 0
    needs: frozenset[int] = frozenset()
    free: bool = False


class HumanControl:
    """Control of one question; ``start``, :meth:`legs` by epoch, :meth:`accepts` at the end."""

    def __init__(self, question: Subproblem, expected: tuple[frozenset[int], ...] = ()) -> None:
        """``expected[j]``: the facts of ``delta(I, pi_H[1..j])`` that the human's domain mentions."""
        self.question = question
        self.plan = question.human_plan
        self.expected = expected
        self._turns = cache(partial(turns, question.task, self.plan))
        options = question.options
        self.literal = options.preservation == "state"
        longest = options.max_window
        self.counted = longest is not None and longest < question.horizon
        self.longest = longest if self.counted else question.horizon
        self.start: Control = (PREFIX, 0, 0) if question.rule != FREE else (ANY, 0, 0)
        own = in_plan(question.task, self.plan).intersection(question.task.human_actions)
        self.any_of_plan = tuple(sorted(own))
        self.idling = tuple(sorted(idling(question.task)))
        due = {i for _, i in question.task.due}
        self.begun = tuple(sorted(due.intersection(question.task.human_actions)))

    def legs(self, control: Control, epoch: int) -> Iterator[Leg]:
        """The ways to spend ``epoch`` after control state ``control``."""
        rule = self.question.rule
        if rule == FREE:
            yield Leg(control, ALL)
        elif rule == ALONE:
            yield Leg(control, OWN)
        elif rule == EXACT:
            yield self._planned(epoch)
        elif control[0] == PREFIX:
            yield from self._prefix(control, epoch)
            if epoch <= len(self.plan):
                tag = epoch if self.literal else 0
                yield Leg((INSIDE, tag, 1 if self.counted else 0), ALL, weight=self.question.prices.epoch)
        elif control[0] == INSIDE:
            _, tag, length = control
            assert self.longest is not None
            if not self.counted or length < self.longest:
                after = (INSIDE, tag, length + 1 if self.counted else 0)
                yield Leg(after, ALL, weight=self.question.prices.epoch)
            yield from self._suffix_starts(tag)
        else:
            yield from self._suffix_goes_on(control)

    def accepts(self, control: Control) -> list[frozenset[int]]:
        """Sets of facts one of which must hold at the end; empty if the plan may not end here."""
        if self.question.rule != "window":
            return [frozenset()]
        if control[0] == PREFIX:
            return []
        if not self.literal:
            return [frozenset()]
        last = self._turns(1)[-1]
        if control[0] == INSIDE or control[1] < 0:
            return [self.expected[last]]
        return [frozenset()] if control[1] >= last else []

    def _prefix(self, control: Control, epoch: int) -> Iterator[Leg]:
        """What is planned; of several plans, what one does that led here."""
        graph = self.question.any_of
        if graph is None or epoch > len(graph):
            yield self._planned(epoch)
            return
        for action, node in graph.moves[epoch - 1][control[1]]:
            yield Leg((PREFIX, node, 0), (action,), wait=False)

    def _planned(self, epoch: int) -> Leg:
        """Eq. (7b) at its own epoch; with the paper's second (7b) any action of the plan."""
        here: Control = (PREFIX, 0, 0)
        if self.question.rule != EXACT and self.question.options.keep_prefix:
            return Leg(here, (*self.any_of_plan, *self.idling))
        if epoch > len(self.plan):
            return Leg(here, (), free=True)
        planned = self.plan[epoch - 1]
        return Leg(here, self.idling if planned in self.idling else (planned,), wait=False)

    def _suffix_starts(self, xi1: int) -> Iterator[Leg]:
        """Eq. (8): from xi2 on the human is alone."""
        if self.literal:
            yield Leg((SUFFIX, -xi1, 0), self.begun, wait=False)
            for j in self._turns(xi1):
                for leg in self._suffix_goes_on((SUFFIX, j, 0)):
                    yield Leg(leg.after, leg.actions, leg.wait, needs=self.expected[j])
        else:
            yield from self._suffix_goes_on((SUFFIX, 0, 0))

    def _suffix_goes_on(self, control: Control) -> Iterator[Leg]:
        _, done, _ = control
        if self.literal and done < 0:  # at something that was begun in the window
            yield from self._suffix_starts(-done)
        elif self.literal:
            yield Leg(control, self.idling)
            rest = (k for k in range(done, len(self.plan)) if self.plan[k] not in self.idling)
            for k in islice(rest, 1):
                yield Leg((SUFFIX, k + 1, 0), (self.plan[k],), wait=False)
        elif self.question.options.suffix == "subplan":
            yield Leg(control, self.idling)
            yield Leg(control, self.begun, wait=False)
            for k in range(done, len(self.plan)):
                yield Leg((SUFFIX, k + 1, 0), (self.plan[k],), wait=False)
        else:
            yield Leg(control, OWN)


def expected_states(question: Subproblem) -> tuple[frozenset[int], ...]:
    """``delta(I, pi_H[1..j])`` for each j, cut down to facts that the human's own domain mentions.

    There are none where no window has to preserve them.
    """
    task, deadline = question.task, question.deadline
    if question.rule != WINDOW or question.options.preservation != "state":
        return ()
    mentioned = facts_of_his(task, deadline)
    return tuple(state & mentioned for state in states_of_pi_h(task, question.human_plan, deadline))
