"""Disjunctive goals hold in a state of the task iff they hold of the text, and change nothing else."""

from __future__ import annotations

import tempfile
from itertools import chain, combinations
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity import InputError, Session, Task, plan, verify
from serendipity.model.task.actions import conflicting
from tests.pddl.texts import action, domain, one, problem, two

PREDICATES = "(p) (q) (at ?w ?x) (on ?w ?x)"
FACTS = ("p", "q", "at h o1", "at h o2", "on h o1", "on h o2", "on r o1", "on r o2")
POSITION = (
    action("go", "(at ?w ?x)", "(not (at ?w ?x)) (at ?w ?y)", "?w - agent ?x ?y - thing"),
    action("on", "(on ?w o1)", "(on ?w o2)", "?w - agent"),
)
CHANGES = (
    action("set", "(at ?w o1)", "(on ?w ?x)", "?w - agent ?x - thing"),
    action("unset", "(on ?w ?x)", "(not (on ?w ?x))", "?w - agent ?x - thing"),
    action("flip", "(on h ?x)", "(not (on h ?x)) (on r ?x)", "?w - agent ?x - thing"),
    "(:action give :parameters (?a ?b - agent ?x - thing) :precondition (and (on ?a ?x) (not (= ?a ?b)))"
    " :effect (and (not (on ?a ?x)) (on ?b ?x)))",
    action("make", "(not (p))", "(p) (not (q))"),
    action("clear", "(p)", "(not (p)) (q)"),
    action("drop", "(at ?who o2)", "(not (on h o1))"),
)

Clause = tuple[tuple[str, bool], ...]


@st.composite
def goals(draw: st.DrawFn) -> list[Clause]:
    """A conjunction of one or two disjunctions of two or three literals."""
    literal = st.tuples(st.sampled_from(FACTS), st.booleans())
    clause = st.lists(literal, min_size=2, max_size=3, unique_by=lambda lit: lit[0]).map(tuple)
    return draw(st.lists(clause, min_size=1, max_size=2))


def text(goal: list[Clause]) -> str:
    literals = [[f"({fact})" if sign else f"(not ({fact}))" for fact, sign in clause] for clause in goal]
    return f"(and {' '.join(f'(or {chr(32).join(clause)})' for clause in literals)})"


def loaded(actions: list[str], init: str, goal: str) -> Task:
    head = domain(*actions, predicates=PREDICATES, constants="h r - agent o1 o2 - thing")
    with tempfile.TemporaryDirectory() as folder:
        return one(Path(folder), head, problem(init, goal, objects=""))


def epochs(task: Task, state: frozenset[int]) -> dict[frozenset[str], frozenset[int]]:
    """Where each set of actions that fits an epoch leads to, by their names."""
    able = [a for a in task.actions if a.applicable(state)]
    found: dict[frozenset[str], frozenset[int]] = {}
    for chosen in chain.from_iterable(combinations(able, count) for count in range(3)):
        if not any(conflicting(a, b, strict=False) for a, b in combinations(chosen, 2)):
            after = state.difference(*(a.delete for a in chosen)).union(*(a.add for a in chosen))
            names = frozenset(a.name for a in chosen)
            assert found.setdefault(names, after) == after
    return found


def check(actions: list[str], init: str, goal: list[Clause]) -> Task | None:
    """Walk through all states of the task, beside one whose goal is a conjunction; None if it is refused."""
    try:
        task = loaded(actions, init, text(goal))
    except InputError as error:
        assert "several agents may change that at once" in str(error) or "can never hold" in str(error)
        return None
    named = " ".join(f"({fact})" for clause in goal for fact, _ in clause)
    beside = loaded(actions, init, f"(and {named})")
    seen, pending = {(task.init, beside.init)}, [(task.init, beside.init)]
    while pending:
        state, plain = pending.pop()
        true = {beside.facts[i] for i in plain}
        assert task.goal.holds(state) == all(
            any((f in true) == sign for f, sign in clause) for clause in goal
        )
        here, there = epochs(task, state), epochs(beside, plain)
        assert here.keys() == there.keys()
        for names, after in here.items():
            pair = after, there[names]
            if pair not in seen:
                seen.add(pair)
                pending.append(pair)
    return task


@given(
    st.lists(st.sampled_from(POSITION + CHANGES), min_size=2, max_size=4, unique=True),
    st.lists(st.sampled_from(FACTS[:2] + FACTS[4:]), max_size=3, unique=True),
    goals(),
)
def test_random_goals(actions: list[str], init: list[str], goal: list[Clause]) -> None:
    check(actions, " ".join(f"({fact})" for fact in ["at h o1", "at r o1", *init]), goal)


GO, ON, SET, UNSET, *_ = POSITION + CHANGES
START = "(at h o1) (at r o1)"


def test_what_stands_for_a_disjunction() -> None:
    task = check([GO], START, [(("at h o1", True), ("at h o2", False))])
    assert task.facts == ("at h o1", "at h o2", "at r o1", "at r o2"), "values of one variable"
    assert (task.goal.positive, task.goal.negative) == ((0,), ())
    task = check([GO, SET], START, [(("on h o2", True), ("on r o1", True))])
    assert task is not None, "what is never undone may be done by anybody"
    assert [task.facts[i] for i in task.goal.positive] == ["either on h o2 or on r o1 holds"]
    task = check([GO, SET, UNSET], START, [(("on h o1", True), ("on h o2", True))])
    assert task is not None, "one agent does and undoes it"
    assert len(task.named["unset h o1"]) == 2
    goal: list[Clause] = [(("on h o1", True), ("on r o1", True))]
    assert check([GO, SET, UNSET], START, goal) is None, "two agents may undo it in one epoch"


@pytest.mark.parametrize(
    ("goal", "cost"),
    [
        ("(exists (?x - thing) (a ?x))", 1),
        ("(imply (a o1) (p))", 0),
        ("(not (and (not (a o1)) (not (a o2))))", 1),
        ("(forall (?x - thing) (or (a ?x) (q)))", 2),
        ("(exists (?x ?y - thing) (and (not (= ?x ?y)) (a ?x) (a ?y)))", 2),
        ("(or (and (a o1) (a o2)) (r))", 2),
    ],
)
def test_plans_for_disjunctive_goals(tmp_path: Path, goal: str, cost: int) -> None:
    add = action("add", "(and)", "(a ?x)", "?who - agent ?x - thing")
    task = one(tmp_path, domain(add, action("q", "(r)", "(q)")), problem("", goal))
    result = plan(task, mode="individual")
    assert result.status == "optimal"
    assert result.cost == cost
    assert all(step.action.startswith("add h") for step in result.plan or ())
    assert verify(task, result).verdict == "proved"


def test_robots_may_have_disjunctive_goals(tmp_path: Path) -> None:
    own = domain(action("add", "(and)", "(p)", ""))
    robots = domain(action("do", "(and)", "(a ?x)", "?x - thing"))
    task = two(tmp_path, (own, problem()), (robots, problem("", "(or (a o1) (a o2))")), human="h")
    assert [task.facts[i] for i in task.robot_goal.positive] == ["either a o1 or a o2 holds"]
    result = plan(task)
    assert result.status == "optimal"
    assert len(result.plan or ()) == 2


def test_what_is_seen_decides_disjunctions_too(tmp_path: Path) -> None:
    add = action("add", "(and)", "(a ?x)", "?who - agent ?x - thing")
    task = one(tmp_path, domain(add), problem("", "(exists (?x - thing) (a ?x))"))
    session = Session(task)
    assert session.plan(mode="individual").cost == 1
    session.change({"a o2": True})
    assert session.plan(mode="individual").cost == 0
    session.change({"a o2": False, "either a o1 or a o2 holds": True})
    assert session.plan(mode="individual").cost == 1
    session.execute(["add h o1"])
    assert session.plan(mode="individual").cost == 0


def test_more_cases_than_are_supported(tmp_path: Path) -> None:
    pairs = " ".join(f"(and (a o{i}) (b o{i}))" for i in range(10))
    objects = f"h r - agent {' '.join(f'o{i}' for i in range(10))} - thing"
    add = action("add", "(and)", "(a ?x) (b ?x)", "?who - agent ?x - thing")
    with pytest.raises(InputError, match=r"problem.pddl:5: more than 256 cases of the goal"):
        one(tmp_path, domain(add), problem("", f"(or {pairs})", objects))
