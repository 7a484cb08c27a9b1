"""Bugs in the rules of actions: what is applicable, what it does, what may share an epoch."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from serendipity.model import GroundAction
from serendipity.model.task.actions import conflicting
from tests.verify.planted.bug import Bug, always, replaced, wrapped
from tests.verify.planted.roles import part


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


def _packed_without_deletes(original: Any, self: Any, action_id: int) -> Any:
    op = original(self, action_id)
    deleted = 0
    for fact in part(self, "task").actions[action_id].delete:
        bits = part(self, "bits of a fact")[fact]
        if bits is not None and fact in part(self, "single facts"):
            deleted |= bits[0]
    return op._replace(keep=op.keep | deleted)


def _positive_only(original: Any, self: Any, positive: Any, negative: Any) -> Any:
    return original(self, positive, ())


def _first_two(original: Any, self: Any, positive: Any, negative: Any) -> Any:
    return original(self, tuple(positive)[:2], negative)


def _useful_by_adding(original: Any, task: Any, *arguments: Any) -> Any:
    """Actions that only delete are thought to be of no use."""
    relevant, useful = original(task, *arguments)
    return relevant, tuple(i for i in useful if relevant.intersection(task.actions[i].add))


def _only_indexed(self: Any, state: int) -> list[Any]:
    found: list[Any] = part(self, "index of operators").get(state & part(self, "indexed variable"), [])
    return found


def _changed_only(self: Any) -> Any:
    return part(self, "variables that operators change")(part(self, "own operators"))


def _one_robot(original: Any, self: Any, state: int) -> list[Any]:
    return [chosen for chosen in original(self, state) if len(chosen.actions) <= 1]


def _idle(original: Any, self: Any, first: Any, state: int) -> tuple[Any, ...]:
    return (first,)


def _without(deed: str) -> Callable[..., Any]:
    def deeds(original: Any, action: GroundAction) -> Any:
        return [found for found in original(action) if found[0] != deed]

    return deeds


BUGS = (
    Bug(
        "whether an action is applicable",
        "negative preconditions are forgotten, by everybody",
        replaced(lambda self, state: all(f in state for f in self.pre)),
    ),
    Bug(
        "whether two actions conflict",
        "an agent may act twice in an epoch",
        replaced(_without_agents),
        survives="a set of actions has one of each agent by how it is put together",
    ),
    Bug(
        "whether two actions conflict",
        "two actions may delete the same fact",
        replaced(_without_double_deletes),
    ),
    Bug("whether two actions conflict", "one may delete what another adds", replaced(_without_adds)),
    Bug("whether two actions conflict", "strict interference is ignored", replaced(_never_strict)),
    Bug("whether two actions conflict", "interference is always strict", replaced(_always_strict)),
    Bug(
        "whether an action disables another",
        "negative preconditions are forgotten",
        replaced(_disables_by_deleting),
    ),
    Bug(
        "whether an operator is applicable",
        "values that a condition forbids are forgotten",
        replaced(lambda op, state: state & op.need_mask == op.need),
    ),
    Bug("packing an action", "deletes of single facts are lost", wrapped(_packed_without_deletes)),
    Bug("packing conditions", "negative conditions are lost", wrapped(_positive_only)),
    Bug("packing conditions", "a third condition is lost", wrapped(_first_two)),
    Bug("actions relevant to the goals", "deleting is of no use", wrapped(_useful_by_adding)),
    Bug("whether two actions may share an epoch", "all may", replaced(always(True))),
    Bug("whether two actions may share an epoch", "none may", replaced(always(False))),
    Bug(
        "whether the goal holds",
        "negative goals are forgotten",
        replaced(lambda self, state: state & self.need_mask == self.need),
    ),
    Bug(
        "operators that an index offers",
        "those without the indexed variable are lost",
        replaced(_only_indexed),
    ),
    Bug(
        "variables of the human's own actions",
        "the key of the cache leaves out what they only ask for",
        replaced(property(_changed_only)),
    ),
    Bug("variables that robots change", "there are none", replaced(property(always(0)))),
    Bug("what robots do beside the human", "nothing, ever", wrapped(_idle)),
    Bug("robots' joint actions", "one robot at a time", wrapped(_one_robot)),
    Bug("joint actions with the human", "never offered", replaced(always([]))),
    Bug("whether an action fits beside others", "it always does", replaced(always(True))),
    Bug("whether a set can be done in some order", "every set can", replaced(always(True))),
    Bug("sets of a team that need one epoch", "there are none", replaced(always(()))),
    Bug(
        "what an action does, while a plan is put into epochs",
        "an agent may act twice in an epoch",
        wrapped(_without("acts")),
    ),
    Bug(
        "what an action does, while a plan is put into epochs",
        "what somebody deletes does not matter",
        wrapped(_without("deletes")),
    ),
)
