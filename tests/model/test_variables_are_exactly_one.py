"""Exactly-one groups hold along every walk, and each fact is in one variable.

Actions are found by name where they stand; a task with another goal keeps what that can not change.
"""

import random
from collections.abc import Collection, Mapping
from dataclasses import replace
from itertools import chain, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Condition, Deadline, GroundAction, LimitReachedError, Task
from serendipity.model.task.exactly_one import Balance
from serendipity.model.task.invariants import groups_by_form
from serendipity.model.task.variables import find_variables
from serendipity_testing.builders import task as build
from serendipity_testing.builders import usar
from serendipity_testing.strategies import Call, calls, tasks

ACTIONS = st.builds(
    lambda pre, neg, add, delete: GroundAction(
        "a",
        (0,),
        tuple(sorted(pre)),
        tuple(sorted(neg - pre)),
        tuple(sorted(add)),
        tuple(sorted(delete - add)),
    ),
    *[st.frozensets(st.integers(0, 7), max_size=3)] * 4,
)

NAMES = st.sampled_from(
    [
        tuple(f"f{i}" for i in range(8)),
        ("at a x", "at a y", "at b x", "at b y", "in a", "in b", "up x", "up y"),
        ("on a a", "on a b", "on b a", "on b b", "held a", "held b", "free a", "free b"),
    ]
)


ATOMS = st.sampled_from(["p x", "p y", "q x y", "q y x", "r x c", "s y x", "u"])


@st.composite
def of_schemas(draw: st.DrawFn) -> Task:
    """Ground actions of random schemas over two or three things."""
    ground = {}
    things = "abc"[: draw(st.integers(2, 3))]
    for k in range(draw(st.integers(1, 4))):
        taken, added = draw(st.lists(ATOMS, min_size=1, max_size=2)), draw(st.lists(ATOMS, max_size=2))
        needed = taken + draw(st.lists(ATOMS, max_size=1))
        lost = taken + ([draw(ATOMS)] if draw(st.integers(0, 3)) == 0 else [])
        for x, y in product(things, repeat=2):
            about = str.maketrans({"x": x, "y": y})
            parts = [frozenset(atom.translate(about) for atom in atoms) for atoms in (needed, added, lost)]
            ground[f"act{k} {x} {y}"] = tuple(parts)
    facts = sorted(frozenset().union(*chain.from_iterable(ground.values())))
    return of_texts(facts, draw(st.frozensets(st.sampled_from(facts))), ground)


@st.composite
def nearly_blocks(draw: st.DrawFn) -> Task:
    """Blocks with up to two actions that have another fact somewhere, which their form does not tell."""
    task = blocks("abc", "r s")
    actions = list(task.actions)
    for _ in range(draw(st.integers(0, 2))):
        i = draw(st.integers(0, len(actions) - 1))
        parts = {"pre": actions[i].pre, "add": actions[i].add, "delete": actions[i].delete}
        part = draw(st.sampled_from(sorted(parts)))
        other = frozenset(parts[part][1:]) | {draw(st.integers(0, len(task.facts) - 1))}
        changed = parts | {part: tuple(sorted(other))}
        changed["delete"] = tuple(f for f in changed["delete"] if f not in changed["add"])
        actions[i] = replace(actions[i], **changed)
    return replace(task, actions=tuple(actions))


def blocks(names: str, hands: str) -> Task:
    """Blocks on a table, and hands that each hold one."""
    ways: dict[str, tuple[str, str]] = {}
    for hand, x in product(hands.split(), names):
        held = f"holding {hand} {x}"
        on_table = f"clear {x},ontable {x},handempty {hand}"
        ways |= {f"pick-up {hand} {x}": (on_table, held), f"put-down {hand} {x}": (held, on_table)}
        for y in names:
            taken, put = f"{held},clear {y}", f"on {x} {y},clear {x},handempty {hand}"
            ways |= {f"stack {hand} {x} {y}": (taken, put), f"unstack {hand} {x} {y}": (put, taken)}
    ground = {}
    for name, texts in sorted(ways.items()):
        pre, add = (frozenset(text.split(",")) for text in texts)
        ground[name] = pre, add, pre
    facts = sorted(frozenset().union(*chain.from_iterable(ground.values())))
    start = [f"{word} {x}" for word in ("clear", "ontable") for x in names]
    return of_texts(facts, {*start, *(f"handempty {hand}" for hand in hands.split())}, ground)


def of_texts(
    facts: list[str], init: Collection[str], ground: Mapping[str, tuple[frozenset[str], ...]]
) -> Task:
    """A task of one agent, from what actions need, add and delete (what they add, they don't delete)."""
    actions = []
    for name, (pre, add, delete) in ground.items():
        pre_ids, add_ids, delete_ids = (
            tuple(i for i, f in enumerate(facts) if f in part) for part in (pre, add, delete - add)
        )
        actions.append(GroundAction(name, (0,), pre_ids, (), add_ids, delete_ids))
    start = frozenset(map(facts.index, init))
    return Task("random", ("h",), 0, tuple(facts), start, Condition(), tuple(actions))


def keeps_exactly_one(group: frozenset[int], action: GroundAction) -> bool:
    """Whether ``action``, applied where exactly one of ``group`` is true, keeps it so."""
    needed = group.intersection(action.pre)
    added = group.intersection(action.add)
    deleted = group.intersection(action.delete)
    if len(needed) > 1 or not (added or deleted):
        return True  # never applicable, or does not touch the group
    if len(added) > 1:
        return False
    if not added:
        return bool(needed) and not needed & deleted
    if needed:
        return needed <= deleted or needed == added
    return group - added <= deleted


def walk(task: Task, steps: int, seed: int) -> list[frozenset[int]]:
    rng = random.Random(seed)
    states = [task.init]
    for _ in range(steps):
        applicable = [a for a in task.actions if a.applicable(states[-1])]
        if not applicable:
            break
        action = rng.choice(applicable)
        states.append(states[-1].difference(action.delete).union(action.add))
    return states


def check(task: Task, seed: int) -> None:
    members = [fact for variable in task.variables for fact in variable.facts]
    assert sorted(members) == list(range(len(task.facts)))
    for state in walk(task, 40, seed):
        for variable in task.variables:
            if not variable.boolean:
                assert sum(fact in state for fact in variable.facts) == 1


@given(tasks(), st.integers(0, 1000))
def test_groups_hold_along_walks(task: Task, seed: int) -> None:
    check(task, seed)


@given(
    NAMES, st.frozensets(st.integers(0, 7), max_size=4), st.lists(ACTIONS, max_size=8), st.integers(0, 1000)
)
def test_groups_hold_whatever_actions_and_names(
    names: tuple[str, ...], init: frozenset[int], actions: list[GroundAction], seed: int
) -> None:
    task = Task("random", ("h",), 0, names, init, Condition(), tuple(actions))
    check(task, seed)
    for variable in find_variables(names, init, actions):
        if not variable.boolean:
            assert all(keeps_exactly_one(frozenset(variable.facts), action) for action in actions)


@given(of_schemas() | nearly_blocks(), st.integers(0, 1000))
def test_groups_by_form_hold_along_walks(task: Task, seed: int) -> None:
    check(task, seed)
    balance = Balance(len(task.facts), task.init, task.actions, Deadline())
    for group in groups_by_form(task.facts, balance, Deadline()):
        assert len(task.init.intersection(group)) == 1
        assert all(keeps_exactly_one(frozenset(group), action) for action in task.actions)


@given(of_schemas() | nearly_blocks())
def test_names_never_make_more_variables(task: Task) -> None:
    nameless = [f"f{i}" for i in range(len(task.facts))]
    assert len(task.variables) <= len(find_variables(nameless, task.init, task.actions))


def test_each_block_is_in_one_place() -> None:
    """Groups of hands ({handempty r, holding r *}) would leave all the others of these facts boolean."""
    task = blocks("abc", "r s")
    groups = {frozenset(task.facts[f] for f in v.facts) for v in task.variables if not v.boolean}
    assert groups == {
        frozenset(
            [f"ontable {x}", *(f"on {x} {y}" for y in "abc"), *(f"holding {hand} {x}" for hand in "rs")]
        )
        for x in "abc"
    }
    left = {task.facts[v.facts[0]] for v in task.variables if v.boolean}
    assert left == {"clear a", "clear b", "clear c", "handempty r", "handempty s"}


def test_an_instance_that_an_action_breaks_is_left_out() -> None:
    """Actions of one schema are alike by their form; here one puts its block into two places."""
    task = blocks("abc", "r s")
    odd = next(i for i, action in enumerate(task.actions) if action.name == "put-down s c")
    two = tuple(sorted(map(task.facts.index, ("on c a", "ontable c", "handempty s"))))
    actions = (*task.actions[:odd], replace(task.actions[odd], add=two), *task.actions[odd + 1 :])
    groups = [{task.facts[f] for f in v.facts} for v in find_variables(task.facts, task.init, actions)]
    places = [group for group in groups if any(fact.startswith("ontable") for fact in group)]
    assert [len(group) for group in places] == [6, 6, 1]


def test_names_of_a_building_change_nothing() -> None:
    task = usar("a-b-c", human="a", robots={"rob": "c"}, kits={"k": "b"}, triage="c")
    nameless = [f"f{i}" for i in range(len(task.facts))]
    assert find_variables(nameless, task.init, task.actions) == task.variables


def test_the_deadline_is_kept_where_names_are_looked_at() -> None:
    task = blocks("abc", "r s")
    balance = Balance(len(task.facts), task.init, task.actions, Deadline())
    with pytest.raises(LimitReachedError):
        groups_by_form(task.facts, balance, Deadline(time_limit=0))


TRACES = {f"move-{x} h": f"{x}0 -> {x}1 trace !{x}0" for x in "abc"}
TRACES |= {f"back-{x} h": f"{x}1 -> {x}0 !{x}1 !trace" for x in "abc"}
BOTH = {
    "both h": "a0 b0 -> a1 b1 !a0 !b0",
    "back h": "a1 -> a0 !a1",
    "on h": "b0 -> b2 !b0",
    "up h": "b2 -> b1 !b2",
}
LOST = {"go h": "a0 -> a1 !a0", "back h": "a1 -> a0 !a1", "lose h": "a1 -> !a1"}


@pytest.mark.parametrize(
    ("init", "actions", "groups"),
    [
        ("a0 b0", BOTH, ["a0 a1", "b0 b1 b2"]),
        ("a0 b0 c0", TRACES, ["a0 a1", "b0 b1", "c0 c1", "trace"]),
        ("a0", LOST, ["a0", "a1"]),
        ("shut", {"open h": "shut -> !shut"}, ["shut"]),
    ],
    ids=["moved together", "a trace that all leave", "a thing that can vanish", "a door that opens for good"],
)
def test_what_looks_like_a_group(init: str, actions: dict[str, str], groups: list[str]) -> None:
    """``b1`` is unbalanced for the group of ``a0``, but not for that of ``b0``, which comes later."""
    task = build(init=init, actions=actions)
    assert [" ".join(task.facts[f] for f in variable.facts) for variable in task.variables] == groups
    assert all(variable.boolean == (len(variable.facts) == 1) for variable in task.variables)


@given(calls(modes=("composite",), ties=False))
def test_every_name_leads_to_its_actions(call: Call) -> None:
    expected: dict[str, tuple[int, ...]] = {}
    for i, action in enumerate(call.task.actions):
        expected[action.name] = (*expected.get(action.name, ()), i)
    assert dict(call.task.named) == expected
    assert len(call.task.named) == len(expected)
    for name in ("", "a", "zz", "no such action", *(f"{name} x" for name in expected)):
        assert name not in call.task.named


def test_names_are_compared_part_by_part() -> None:
    names = ["a", "a b", "a b c", "a-b", "a! c", "b"]
    task = build(goal="g", actions={f"{name} h": "-> g" for name in names})
    assert [action.key for action in task.actions] == sorted(action.key for action in task.actions)
    for name in names:
        (found,) = task.named[f"{name} h"]
        assert task.actions[found].name == f"{name} h"


def test_another_goal_keeps_the_variables() -> None:
    """They were found again for each goal, which took longer than a short limit."""
    task = serendipity.example("room2")
    other = task.with_goal(Condition((0,)), Condition())
    assert other.variables is task.variables
    assert other.goal == Condition((0,))
    assert other == Task(
        task.name,
        task.agents,
        task.human,
        task.facts,
        task.init,
        Condition((0,)),
        task.actions,
        Condition(),
        task.warnings,
    )
    assert task.with_goal(Condition((0,))).robot_goal == task.robot_goal
