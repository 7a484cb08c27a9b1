"""Conditions and effects of every form, against an interpreter of the lifted text."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from serendipity import Task
from tests.pddl.texts import action, domain, one, problem

OBJECTS = ("o1", "o2", "o3")
FACTS = ("p", "q", *(f"a {o}" for o in OBJECTS))
STATIC = frozenset({"s o1", "s o3"})
Env = dict[str, str]


@dataclass(frozen=True)
class Node:
    """A formula, ``op`` being one of atom, eq, and, or, not, imply, forall, exists."""

    op: str
    words: tuple[str, ...] = ()
    parts: tuple[Node, ...] = ()

    def text(self) -> str:
        inner = " ".join(part.text() for part in self.parts)
        match self.op:
            case "atom":
                return f"({' '.join(self.words)})"
            case "eq":
                return f"(= {' '.join(self.words)})"
            case "forall" | "exists":
                return f"({self.op} ({self.words[0]} - thing) {inner})"
            case _:
                return f"({self.op} {inner})"

    def holds(self, state: frozenset[str], env: Env) -> bool:
        values = [env.get(word, word) for word in self.words]
        match self.op:
            case "atom":
                return " ".join(values) in state
            case "eq":
                return values[0] == values[1]
            case "and":
                return all(part.holds(state, env) for part in self.parts)
            case "or":
                return any(part.holds(state, env) for part in self.parts)
            case "not":
                return not self.parts[0].holds(state, env)
            case "imply":
                return not self.parts[0].holds(state, env) or self.parts[1].holds(state, env)
        over = [self.parts[0].holds(state, env | {self.words[0]: o}) for o in OBJECTS]
        return all(over) if self.op == "forall" else any(over)


@dataclass(frozen=True)
class Change:
    """``literal``, for all values of ``each``, where ``when`` holds."""

    words: tuple[str, ...]
    positive: bool
    when: Node | None = None
    each: str | None = None

    def text(self) -> str:
        text = f"({' '.join(self.words)})"
        text = text if self.positive else f"(not {text})"
        text = text if self.when is None else f"(when {self.when.text()} {text})"
        return text if self.each is None else f"(forall ({self.each} - thing) {text})"

    def facts(self, state: frozenset[str], env: Env) -> set[str]:
        envs = [env] if self.each is None else [env | {self.each: o} for o in OBJECTS]
        return {
            " ".join(e.get(word, word) for word in self.words)
            for e in envs
            if self.when is None or self.when.holds(state, e)
        }


def terms(variables: tuple[str, ...]) -> st.SearchStrategy[str]:
    return st.sampled_from((*variables, "o1"))


@st.composite
def atoms(draw: st.DrawFn, variables: tuple[str, ...]) -> Node:
    match draw(st.sampled_from(["p", "q", "a", "a", "s", "eq"])):
        case "eq":
            return Node("eq", (draw(terms(variables)), draw(terms(variables))))
        case ("a" | "s") as predicate:
            return Node("atom", (predicate, draw(terms(variables))))
        case predicate:
            return Node("atom", (predicate,))


@st.composite
def formulas(draw: st.DrawFn, variables: tuple[str, ...], depth: int) -> Node:
    op = draw(st.sampled_from(["atom", "not", "and", "or", "imply", "forall", "exists"])) if depth else "atom"
    match op:
        case "atom":
            return draw(atoms(variables))
        case "not":
            return Node("not", (), (draw(formulas(variables, depth - 1)),))
        case "and" | "or":
            return Node(op, (), tuple(draw(st.lists(formulas(variables, depth - 1), max_size=2))))
        case "imply":
            return Node(op, (), (draw(formulas(variables, depth - 1)), draw(formulas(variables, depth - 1))))
    bound = draw(st.sampled_from(["?y", "?z", "?x"]))
    return Node(op, (bound,), (draw(formulas((*variables, bound), depth - 1)),))


@st.composite
def changes(draw: st.DrawFn) -> Change:
    each = draw(st.sampled_from([None, None, "?y"]))
    variables = ("?x",) if each is None else ("?x", each)
    predicate = draw(st.sampled_from(["p", "q", "a", "a"]))
    words = (predicate, draw(terms(variables))) if predicate == "a" else (predicate,)
    when = draw(st.none() | formulas(variables, 1))
    return Change(words, draw(st.booleans()), when, each)


def successors(task: Task, name: str, state: frozenset[str]) -> set[frozenset[str]]:
    """What the ground actions of that name lead to."""
    ids = frozenset(i for i, fact in enumerate(task.facts) if fact in state)
    found = set()
    for i in task.named.get(name, ()):
        ground = task.actions[i]
        if ground.applicable(ids):
            after = ids.difference(ground.delete) | set(ground.add)
            found.add(frozenset(task.facts[f] for f in after))
    return found


@given(formulas(("?x",), 3), st.lists(changes(), min_size=1, max_size=3))
def test_ground_actions_do_what_the_lifted_text_says(condition: Node, effects: list[Change]) -> None:
    flips = [
        action(f"make{i}", f"(not ({fact}))", f"({fact})")
        + action(f"undo{i}", f"({fact})", f"(not ({fact}))")
        for i, fact in enumerate(FACTS)
    ]
    text = domain(
        *flips,
        action("act", condition.text(), " ".join(e.text() for e in effects), "?who - agent ?x - thing"),
        predicates="(p) (q) (a ?x - thing) (s ?x - thing)",
        constants="o1 o2 o3 - thing",
    )
    init = " ".join(f"({fact})" for fact in STATIC)
    with tempfile.TemporaryDirectory() as folder:
        task = one(Path(folder), text, problem(init=init, objects="h r - agent o1 o2 o3 - thing"))
    assert set(FACTS) <= set(task.facts)
    for values in product([False, True], repeat=len(FACTS)):
        state = frozenset(fact for fact, value in zip(FACTS, values, strict=True) if value)
        full = state | STATIC
        for x in OBJECTS:
            env = {"?x": x}
            if not condition.holds(full, env):
                assert successors(task, f"act h {x}", state) == set()
                continue
            add = set().union(*(e.facts(full, env) for e in effects if e.positive))
            delete = set().union(*(e.facts(full, env) for e in effects if not e.positive))
            after = frozenset(state - delete | add)
            found = successors(task, f"act h {x}", state)
            assert found == {after} or (not found and after == state)  # a noop is dropped
