"""Bugs in the rules of actions: what is applicable, what it does, what may share an epoch."""

from dataclasses import replace
from typing import Any

from search.packed import operators as ops
from search.packed import packed_task
from search.packed import parallelise as schedule
from search.packed.operator_index import OperatorIndex
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal, PackedTask
from search.packed.successor_generator import JointAction, Successors
from serendipity.model import GroundAction
from serendipity.model.actions import conflicting, disables
from tests.verify.planted.bug import Bug, always, everywhere, replaced, wrapped


def _without_agents(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    return conflicting(replace(a, participants=(99,)), b, strict=strict)


def _without_double_deletes(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    both = set(a.delete) & set(b.delete)
    return conflicting(replace(a, delete=tuple(f for f in a.delete if f not in both)), b, strict=strict)


def _without_adds(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    return conflicting(replace(a, add=()), replace(b, add=()), strict=strict)


def _never_strict(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    return conflicting(a, b, strict=False)


def _always_strict(a: GroundAction, b: GroundAction, *, strict: bool) -> bool:
    return conflicting(a, b, strict=True)


def _disables_by_deleting(a: GroundAction, b: GroundAction) -> bool:
    return any(f in b.pre for f in a.delete)


def _packed_without_deletes(original: Any, self: PackedTask, action_id: int) -> Operator:
    op: Operator = original(self, action_id)
    deleted = 0
    for fact in self.task.actions[action_id].delete:
        bits = self.fact_bits[fact]
        if bits is not None and fact in self.boolean:
            deleted |= bits[0]
    return op._replace(keep=op.keep | deleted)


def _positive_only(original: Any, self: PackedTask, positive: Any, negative: Any) -> Any:
    return original(self, positive, ())


def _first_two(original: Any, self: PackedTask, positive: Any, negative: Any) -> Any:
    return original(self, tuple(positive)[:2], negative)


def _useful_by_adding(original: Any, task: Any, *arguments: Any) -> Any:
    """Actions that only delete are thought to be of no use."""
    relevant, useful = original(task, *arguments)
    return relevant, tuple(i for i in useful if relevant.intersection(task.actions[i].add))


def _only_indexed(self: OperatorIndex[Operator], state: int) -> list[Operator]:
    return self.by_value.get(state & self.field, [])


def _one_robot(original: Any, self: Successors, state: int) -> list[JointAction]:
    return [option for option in original(self, state) if len(option.actions) <= 1]


def _idle(original: Any, self: Successors, first: JointAction, state: int) -> tuple[JointAction, ...]:
    return (first,)


BUGS = (
    Bug(
        "model/actions: applicable",
        "negative preconditions are forgotten, by everybody",
        replaced(GroundAction, "applicable", lambda self, state: all(f in state for f in self.pre)),
        "the search packs actions by itself, and the verifier has its own rule",
    ),
    Bug(
        "model/actions: conflicting",
        "an agent may act twice in an epoch",
        everywhere(conflicting, _without_agents),
    ),
    Bug(
        "model/actions: conflicting",
        "two actions may delete the same fact",
        everywhere(conflicting, _without_double_deletes),
    ),
    Bug(
        "model/actions: conflicting",
        "one may delete what another adds",
        everywhere(conflicting, _without_adds),
    ),
    Bug(
        "model/actions: conflicting", "strict interference is ignored", everywhere(conflicting, _never_strict)
    ),
    Bug(
        "model/actions: conflicting", "interference is always strict", everywhere(conflicting, _always_strict)
    ),
    Bug(
        "model/actions: disables",
        "negative preconditions are forgotten",
        everywhere(disables, _disables_by_deleting),
    ),
    Bug(
        "ops: applicable",
        "values that a condition forbids are forgotten",
        everywhere(ops.applicable, lambda op, state: state & op.need_mask == op.need),
    ),
    Bug(
        "encoding: Encoding.op",
        "deletes of single facts are lost",
        wrapped(PackedTask, "_pack_action", _packed_without_deletes),
    ),
    Bug(
        "encoding: Encoding.op",
        "negative conditions are lost",
        wrapped(PackedTask, "_literals", _positive_only),
    ),
    Bug("encoding: Encoding.op", "a third condition is lost", wrapped(PackedTask, "_literals", _first_two)),
    Bug(
        "encoding: relevance",
        "deleting is of no use",
        wrapped(packed_task, "relevant_to_goals", _useful_by_adding),
    ),
    Bug("encoding: Encoding.compatible", "everything is", replaced(PackedTask, "compatible", always(True))),
    Bug("encoding: Encoding.compatible", "nothing is", replaced(PackedTask, "compatible", always(False))),
    Bug(
        "encoding: Goal.holds",
        "negative goals are forgotten",
        replaced(PackedGoal, "holds", lambda self, state: state & self.need_mask == self.need),
    ),
    Bug(
        "ops: OpIndex",
        "ops without the indexed field are lost",
        replaced(OperatorIndex, "candidates", _only_indexed),
    ),
    Bug(
        "encoding: own_mask",
        "the key of the cache leaves out what he only asks for",
        replaced(PackedTask, "own_mask", property(lambda self: self.changed_by(self.own))),
    ),
    Bug(
        "encoding: outside",
        "robots are thought to change nothing",
        replaced(PackedTask, "outside", property(always(0))),
    ),
    Bug(
        "successors: with_robots",
        "robots never act",
        wrapped(Successors, "with_robots", _idle),
    ),
    Bug("successors: robots", "one robot at a time", wrapped(Successors, "robots", _one_robot)),
    Bug("successors: joint", "never offered", replaced(Successors, "joint", always([]))),
    Bug(
        "successors: _fits",
        "everything does",
        replaced(Successors, "_fits", always(True)),
    ),
    Bug(
        "successors: sequential",
        "every set is",
        replaced(Successors, "sequential", always(True)),
    ),
    Bug(
        "schedule",
        "sets that disturb each other share an epoch",
        replaced(schedule, "conflicting", always(False)),
    ),
)
