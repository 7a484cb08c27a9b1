"""Bugs in the rules of actions: what is applicable, what it does, what may share an epoch."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from search.classical import team
from search.packed import operators, packed_task, parallelise
from search.packed.due import Due
from search.packed.operator_index import OperatorIndex
from search.packed.packed_task import PackedGoal, PackedTask
from search.packed.successor_generator import Successors
from serendipity.model.task import actions
from serendipity.model.task.actions import GroundAction, conflicting
from tests.verify.planted.bug import Bug, Change, always, asked, replaced, returning, wrapped


def _without_double_deletes(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    both = set(a.delete) & set(b.delete)
    return conflicting(replace(a, delete=tuple(f for f in a.delete if f not in both)), b, strict=strict)


def _without_adds(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    return conflicting(replace(a, add=()), replace(b, add=()), strict=strict)


def _disables_by_deleting(a: GroundAction, b: GroundAction) -> bool:
    return any(f in b.pre for f in a.delete)


def _packed_without_deletes(original: Any, self: Any, action_id: int) -> Any:
    op = original(self, action_id)
    deleted = 0
    for fact in self.task.actions[action_id].delete:
        bits = self.fact_bits[fact]
        if bits is not None and fact in self.boolean:
            deleted |= bits[0]
    return op._replace(keep=op.keep | deleted)


def _first_two(original: Any, self: Any, positive: Any, negative: Any) -> Any:
    return original(self, tuple(positive)[:2], negative)


def _useful_by_adding(original: Any, task: Any, *arguments: Any) -> Any:
    """Actions that only delete are thought to be of no use."""
    relevant, useful = original(task, *arguments)
    return relevant, tuple(i for i in useful if relevant.intersection(task.actions[i].add))


def _only_indexed(self: Any, state: int) -> list[Any]:
    found: list[Any] = self.by_value.get(state & self.field, [])
    return found


def _at_most_one(sets: Iterable[Any]) -> list[Any]:
    return [chosen for chosen in sets if len(chosen.actions) <= 1]


def _without(deed: str) -> Change:
    return returning(lambda deeds: [found for found in deeds if found[0] != deed])


BUGS = (
    Bug(
        GroundAction,
        "applicable",
        "negative preconditions are forgotten, by everybody",
        replaced(lambda self, state: all(f in state for f in self.pre)),
    ),
    Bug(actions, "conflicting", "two actions may delete the same fact", replaced(_without_double_deletes)),
    Bug(actions, "conflicting", "one may delete what another adds", replaced(_without_adds)),
    Bug(actions, "conflicting", "strict interference is ignored", asked(strict=always(False))),
    Bug(actions, "conflicting", "interference is always strict", asked(strict=always(True))),
    Bug(actions, "disables", "negative preconditions are forgotten", replaced(_disables_by_deleting)),
    Bug(
        operators,
        "applicable",
        "values that a condition forbids are forgotten",
        replaced(lambda op, state: state & op.need_mask == op.need),
    ),
    Bug(PackedTask, "_pack_action", "deletes of single facts are lost", wrapped(_packed_without_deletes)),
    Bug(
        PackedTask,
        "_literals",
        "negative conditions are lost",
        wrapped(lambda pack, task, need, _: pack(task, need, ())),
    ),
    Bug(PackedTask, "_literals", "a third condition is lost", wrapped(_first_two)),
    Bug(packed_task, "relevant_to_goals", "deleting is of no use", wrapped(_useful_by_adding)),
    Bug(PackedTask, "compatible", "all may", replaced(always(True))),
    Bug(PackedTask, "compatible", "none may", replaced(always(False))),
    Bug(
        PackedGoal,
        "holds",
        "negative goals are forgotten",
        replaced(lambda self, state: state & self.need_mask == self.need),
    ),
    Bug(OperatorIndex, "candidates", "those without the indexed variable are lost", replaced(_only_indexed)),
    Bug(
        PackedTask,
        "own_mask",
        "the key of the cache leaves out what they only ask for",
        replaced(property(lambda self: self.changed_by(self.own))),
    ),
    Bug(PackedTask, "outside", "there are none", replaced(property(always(0)))),
    Bug(Successors, "with_robots", "nothing, ever", wrapped(lambda _, __, first, ___: (first,))),
    Bug(Successors, "robots", "one robot at a time", returning(_at_most_one)),
    Bug(Successors, "joint", "never offered", replaced(always([]))),
    Bug(Due, "fits", "it always does", replaced(always(True))),
    Bug(Successors, "sequential", "every set can", replaced(always(True))),
    Bug(team, "circles", "there are none", replaced(always(()))),
    Bug(parallelise, "_deeds", "an agent may act twice in an epoch", _without("acts")),
    Bug(parallelise, "_deeds", "what somebody deletes does not matter", _without("deletes")),
)
