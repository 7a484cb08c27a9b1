"""Finite-domain variables behind the facts: exactly-one groups.

A group is a set of facts of which exactly one is true in every reachable state
(a position, who holds a kit).  Groups are grown from facts that are true initially
(:mod:`.grown_groups`).  Where that leaves much boolean that actions consume, they are looked
for by the form of the facts' names as well (:mod:`.invariants`).
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final

from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.exactly_one import Balance
from serendipity.model.task.grown_groups import Group, grown_groups
from serendipity.model.task.invariants import groups_by_form

_MANY: Final = 0.25
"""The share of consumed facts in no group from which on groups are looked for by form, too.
On the 80 tasks of docs/benchmarks.md it is at least 0.33 in blocks and depots, at most 0.14 elsewhere;
in large buildings 0.0001."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A finite-domain variable.

    Attributes:
        facts: ids of its facts, ascending.  Two or more: exactly one is true in every
            reachable state.  One: a fact by itself, true or false.
    """

    facts: tuple[int, ...]

    @property
    def boolean(self) -> bool:
        """Whether it is a single fact, true or false."""
        return len(self.facts) == 1


def find_variables(
    facts: Sequence[str],
    init: frozenset[int],
    actions: Sequence[GroundAction],
    deadline: Deadline | None = None,
    first: Collection[int] = (),
) -> tuple[Variable, ...]:
    """Partition facts into variables, ascending in their first fact.

    Sound for every input: a group that is not exactly-one under each action is not
    reported, whatever the names.  Not complete: some groups that exist may be missed.

    Args:
        first: facts, true initially, whose groups matter more than those of others.
    """
    deadline = deadline or Deadline()
    balance = Balance(len(facts), init, actions, deadline)
    groups = grown_groups(balance, deadline, (), first)
    if _much_is_boolean(balance, groups):
        groups = max(groups, _by_form_first(facts, balance, deadline), key=_spared)  # the former in a tie
    grouped = set(chain.from_iterable(groups))
    singles = ((fact,) for fact in range(len(facts)) if fact not in grouped)
    return tuple(Variable(values) for values in sorted(chain(groups, singles)))


def _much_is_boolean(balance: Balance, groups: Sequence[Group]) -> bool:
    grouped = set(chain.from_iterable(groups))
    consumed = [fact for fact, actions in enumerate(balance.consumers) if actions]
    return sum(fact not in grouped for fact in consumed) > _MANY * len(consumed)


def _by_form_first(facts: Sequence[str], balance: Balance, deadline: Deadline) -> list[Group]:
    """Groups by form, and others among what is left; none where names have no form."""
    found = groups_by_form(facts, balance, deadline)
    return [*found, *grown_groups(balance, deadline, found)] if found else []


def _spared(groups: Sequence[Group]) -> int:
    """The number of facts less the number of variables."""
    return sum(len(group) - 1 for group in groups)
