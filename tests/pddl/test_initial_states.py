"""Initial states: literals of both signs, in one file and in several."""

from pathlib import Path

import pytest

from serendipity import InputError
from tests.pddl.texts import action, domain, facts, one, problem, two

TEXT = domain(action("go", "(and (q) (not (r)))", "(p) (not (q)) (r)"))


def test_a_negative_literal_says_what_its_absence_says(tmp_path: Path) -> None:
    task = one(tmp_path, TEXT, problem("(not (r)) (q)"))
    assert task == one(tmp_path, TEXT, problem("(q)"))
    assert facts(task, task.init) == {"q"}


def test_a_literal_and_its_negation(tmp_path: Path) -> None:
    init = "(q)\n(not (q))"
    with pytest.raises(InputError, match=r"problem.pddl:5: initial state: 'q' is both true and false"):
        one(tmp_path, TEXT, problem(init))


@pytest.mark.parametrize(
    ("literal", "message"),
    [
        ("(not (red))", "unknown predicate 'red'"),
        ("(not (q) (r))", "expected '\\)', got '\\(r\\)'"),
        ("(not q)", "expected an atom, got 'q'"),
        ("(not)", "expected an atom, got '\\)'"),
        ("(not (not (q)))", "'not' is not possible here"),
        ("q", "expected an atom, got 'q'"),
        ("()", "expected a predicate, got '\\)'"),
        ("((q))", "expected a predicate, got '\\(q\\)'"),
        ("(a (q))", "expected an object or a variable, got '\\(q\\)'"),
        ("(a ?x)", "variable '\\?x' is not declared"),
    ],
)
def test_what_is_no_literal(tmp_path: Path, literal: str, message: str) -> None:
    with pytest.raises(InputError, match=f"problem.pddl:4: initial state: {message}"):
        one(tmp_path, TEXT, problem(literal))


def test_what_one_file_denies_no_other_may_state(tmp_path: Path) -> None:
    first, second = problem("(q)"), problem("\n(not (q))", goal="")
    with pytest.raises(InputError, match=r"r-problem.pddl:5: 'q' is false here, true in .*h-problem.pddl"):
        two(tmp_path, (TEXT, first), (TEXT, second))
