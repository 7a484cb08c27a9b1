"""Ground actions against an enumeration of all arguments, kept as far as they can be executed."""

import tempfile
from itertools import product
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from tests.pddl.texts import action, domain, one, problem

OBJECTS = ("o1", "o2", "o3")
CONSTANTS = "o1 o2 o3 - thing"
TERMS = ("?x", "?y", "?z", "o1")
PREDICATES = "(s ?x) (c ?x ?y) (f ?x ?y) (g ?x) (h ?x ?y)"
ARITY = {"s": 1, "c": 2, "f": 2, "g": 1, "h": 2, "=": 2}

Atom = tuple[str, ...]
Literal = tuple[bool, Atom]
Lifted = tuple[list[Literal], list[Literal]]  # precondition, effects
Sets = tuple[frozenset[Atom], frozenset[Atom], frozenset[Atom]]  # needs, makes true, makes false


def atoms(predicates: str, terms: tuple[str, ...]) -> st.SearchStrategy[Atom]:
    """Atoms of some predicates (s and c never change, all of f hold at first, no g nor h does)."""
    term = st.sampled_from(terms)
    return st.sampled_from(predicates).flatmap(lambda p: st.tuples(st.just(p), *[term] * ARITY[p]))


def literals(positive: str, negative: str) -> st.SearchStrategy[Literal]:
    return st.tuples(st.just(True), atoms(positive, TERMS)) | st.tuples(
        st.just(False), atoms(negative, TERMS)
    )


LIFTED: st.SearchStrategy[Lifted] = st.tuples(
    st.lists(literals("scfgghh", "sc=="), max_size=4),
    st.lists(literals("fghh", "fgh"), min_size=1, max_size=3),
)


def text(literal: Literal) -> str:
    atom = f"({' '.join(literal[1])})"
    return atom if literal[0] else f"(not {atom})"


def ground(literals: list[Literal], values: dict[str, str], positive: bool) -> frozenset[Atom]:
    return frozenset((a[0], *(values.get(t, t) for t in a[1:])) for p, a in literals if p is positive)


def possible(actions: dict[str, Lifted], static: frozenset[Atom]) -> dict[str, Sets]:
    """What each ground action needs and does, for those that can be executed if nothing is deleted."""
    true = (
        set(static) | {("=", o, o) for o in OBJECTS} | {("f", *pair) for pair in product(OBJECTS, repeat=2)}
    )
    candidates = {}
    for name, (condition, effects) in actions.items():
        for objects in product(OBJECTS, repeat=3):
            values = dict(zip(("?x", "?y", "?z"), objects, strict=True))
            if ground(condition, values, False).isdisjoint(true):  # only of s, c and =, which stay
                add, delete = ground(effects, values, True), ground(effects, values, False)
                needs = ground(condition, values, True)
                candidates[f"{name} h {' '.join(objects)}"] = needs, add, delete - add
    kept: dict[str, Sets] = {}
    while ready := {name: sets for name, sets in candidates.items() if name not in kept and sets[0] <= true}:
        kept |= ready
        true.update(atom for _, add, _ in ready.values() for atom in add)
    return {
        name: (frozenset(atom for atom in needs if atom[0] not in "sc="), add, delete)
        for name, (needs, add, delete) in kept.items()
    }


@given(LIFTED, LIFTED, st.frozensets(atoms("scc", OBJECTS), min_size=3, max_size=9))
def test_ground_actions_are_those_that_can_be_executed(
    first: Lifted, second: Lifted, static: frozenset[Atom]
) -> None:
    undo: Lifted = ([(True, ("f", "?x", "?y"))], [(False, ("f", "?x", "?y"))])  # so that no f holds for good
    actions = {"a": first, "b": second, "undo": undo}
    texts = [
        action(name, f"(and {' '.join(map(text, pre))})", " ".join(map(text, effects)), parameters)
        for name, (pre, effects) in actions.items()
        for parameters in ["?who - agent ?x ?y ?z - thing"]
    ]
    head = domain(*texts, predicates=PREDICATES, constants=CONSTANTS)
    pairs = [("f", *pair) for pair in product(OBJECTS, repeat=2)]
    init = " ".join(text((True, atom)) for atom in [*static, *pairs])
    with tempfile.TemporaryDirectory() as folder:
        task = one(Path(folder), head, problem(init=init, goal="(f o1 o1)", objects="h r - agent"))

    def names(ids: tuple[int, ...]) -> frozenset[Atom]:
        return frozenset(tuple(task.facts[i].split()) for i in ids)

    found = {a.name: (names(a.pre), names(a.add), names(a.delete)) for a in task.actions if " h " in a.name}
    assert found == possible(actions, static)
    assert all(ids == tuple(sorted({*ids})) for a in task.actions for ids in (a.pre, a.add, a.delete))
