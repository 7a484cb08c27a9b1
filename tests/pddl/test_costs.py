"""What actions cost: PDDL's total-cost, or 1 each."""

from fractions import Fraction
from pathlib import Path

import pytest

from serendipity import InputError
from tests.pddl.texts import action, domain, one, problem, two

METRIC = "(:metric minimize (total-cost))"


def costs(folder: Path, effect: str, init: str = "(q)", more: str = "", functions: str = "") -> set[Fraction]:
    text = domain(action("go", "(q)", effect), functions=functions)
    return {a.cost for a in one(folder, text, problem(init=init, more=more)).actions}


@pytest.mark.parametrize(
    ("effect", "more", "cost"),
    [
        ("(p)", "", 1),
        ("(p)", METRIC, 0),
        ("(p) (increase (total-cost) 1) (increase (total-cost) 0.5)", "", Fraction(3, 2)),
    ],
    ids=["without costs it is one", "with a metric, none where nothing is said", "increases add up"],
)
def test_what_an_action_costs(tmp_path: Path, effect: str, more: str, cost: Fraction) -> None:
    assert costs(tmp_path, effect, more=more) == {cost}


def test_with_another_priced_action_an_action_that_says_nothing_is_free(tmp_path: Path) -> None:
    text = domain(action("go", "(q)", "(p)"), action("run", "(q)", "(p) (increase (total-cost) 2)"))
    task = one(tmp_path, text, problem(init="(q)"))
    assert {a.name: a.cost for a in task.actions} == {"go h": 0, "go r": 0, "run h": 2, "run r": 2}


def test_the_convention_holds_for_each_file(tmp_path: Path) -> None:
    priced = domain(action("go", "(q)", "(p) (increase (total-cost) 3)", parameters=""))
    plain = domain(action("run", "(q)", "(p)", parameters=""))
    task = two(tmp_path, (priced, problem(init="(q)")), (plain, problem(init="(q)", goal="")))
    assert {a.name: a.cost for a in task.actions} == {"go": 3, "run": 1}


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("0.01", Fraction(1, 100)),
        ("1e-3", Fraction(1, 1000)),
        (".5", Fraction(1, 2)),
        ("(+ 1 (* 2 3))", Fraction(7)),
        ("(/ 1 3)", Fraction(1, 3)),
        ("(- (far) 0.5)", Fraction(2)),
    ],
)
def test_expressions(tmp_path: Path, expression: str, value: Fraction) -> None:
    effect = f"(p) (increase (total-cost) {expression})"
    assert costs(tmp_path, effect, init="(q) (= (far) 2.5)", functions="(far)") == {value}


@pytest.mark.parametrize("value", ["2", "0.5", "-10", "1"])
def test_products_may_be_long_but_not_costs(tmp_path: Path, value: str) -> None:
    def product(of: str) -> set[Fraction]:
        effect = f"(p) (increase (total-cost) (* {' '.join([of] * 1001)}))"
        return costs(tmp_path, effect, init=f"(q) (= (c) {value})", functions="(c)")

    for of in ("(c)", value):
        if value == "1":
            assert product(of) == {1}
        else:
            with pytest.raises(InputError, match=r"action 'go.*: expected a cost of at most 200 digits"):
                product(of)


@pytest.mark.parametrize(
    ("effect", "init", "message"),
    [
        ("(p) (increase (total-cost) -1)", "(q)", "cost of at least 0, got -1"),
        (
            "(p) (increase (total-cost) (- (far) 3))",
            "(q) (= (far) 2)",
            "'go h': expected a cost of at least 0",
        ),
        ("(p) (increase (total-cost) (far))", "(q)", "no initial value of 'far'"),
        ("(p) (increase (total-cost) (/ 1 (far)))", "(q) (= (far) 0)", "division by zero"),
        ("(p) (increase (far) 1)", "(q)", "numeric effects are not supported"),
        ("(p) (when (q) (increase (total-cost) 1))", "(q)", "conditional action costs are not supported"),
        ("(p) (increase (total-cost) 1e999999999)", "(q)", "expected a number"),
        ("(p) (increase (total-cost) (total-cost))", "(q)", "depends on the total cost so far is not supp"),
        ("(p) (increase (total-cost) (+ 1 (* 2 (total-cost))))", "(q)", "depends on the total cost"),
        ("(p) (increase (total-cost))", "(q)", "expected a number or a function, got '\\)'"),
        ("(p) (increase (total-cost) (- (far)))", "(q) (= (far) 1)", "expected two values to -, got '\\)'"),
    ],
)
def test_bad_costs(tmp_path: Path, effect: str, init: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        costs(tmp_path, effect, init=init, functions="(far)")
    assert caught.value.line == 5
    assert caught.value.file.endswith("domain.pddl")


def test_two_values_of_one_function(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"problem.pddl:4: initial state: 'far' is given two values"):
        costs(tmp_path, "(p)", init="(q) (= (far) 1) (= (far) 2)", functions="(far)")


def test_files_that_disagree_on_a_value(tmp_path: Path) -> None:
    text = domain(action("go", "(q)", "(p) (increase (total-cost) (far))"), functions="(far)")
    first, second = problem(init="(q) (= (far) 1)"), problem(init="(q) (= (far) 2)", goal="")
    with pytest.raises(InputError, match=r"r-problem.pddl: 'far' is 2 here, 1 in another"):
        two(tmp_path, (text, first), (text, second))


@pytest.mark.parametrize(
    "metric", ["(:metric maximize (total-cost))", "(:metric minimize (+ (total-cost) 1))"]
)
def test_other_metrics(tmp_path: Path, metric: str) -> None:
    with pytest.raises(InputError, match=r"problem.pddl:6: the only metric supported"):
        costs(tmp_path, "(p)", more=metric)


def test_where_the_total_cost_starts_has_no_effect(tmp_path: Path) -> None:
    assert costs(tmp_path, "(p) (increase (total-cost) 2)", init="(q) (= (total-cost) 7)") == {2}
    text = domain(action("go", "(q)", "(p) (increase (total-cost) 2)"))
    first, second = problem("(q) (= (total-cost) 1)"), problem("(q) (= (total-cost) 2)", goal="")
    assert {a.cost for a in two(tmp_path, (text, first), (text, second)).actions} == {2}


LINKS = "(link ?x ?y) (at ?who ?x) (open ?x)"
MOVE = "(not (at ?who ?x)) (at ?who ?y) (increase (total-cost) (dist ?x ?y))"
OBJECTS = "h r - agent a b c - thing"
DISTANCES = "(= (dist a b) 1) (= (dist b a) 2) (= (dist b c) 3) (= (dist c b) 4)"
PLACE = f"(at h a) (at r b) (link a b) (link b c) {DISTANCES}"


@pytest.mark.parametrize(
    "condition",
    [
        "(and (at ?who ?x) (or (link ?x ?y) (link ?y ?x)))",
        "(and (at ?who ?x) (not (and (not (link ?x ?y)) (not (link ?y ?x)))))",
        "(and (at ?who ?x) (exists (?z - thing) (and (= ?y ?z) (or (link ?x ?z) (link ?z ?x)))))",
    ],
)
def test_no_cost_is_asked_for_where_static_conditions_exclude_the_action(
    tmp_path: Path, condition: str
) -> None:
    text = domain(
        action("move", condition, MOVE, "?who - agent ?x ?y - thing"),
        predicates=LINKS,
        functions="(dist ?x ?y)",
    )
    task = one(tmp_path, text, problem(PLACE, "(at h c)", OBJECTS))
    assert {a.name.removeprefix("move h "): a.cost for a in task.actions if " h " in a.name} == {
        "a b": 1,
        "b a": 2,
        "b c": 3,
        "c b": 4,
    }


def test_no_cost_is_asked_for_where_an_action_is_out_of_reach(tmp_path: Path) -> None:
    text = domain(
        action("move", "(and (at ?who ?x) (open ?y))", MOVE, "?who - agent ?x ?y - thing"),
        action("unlock", "(and (at ?who ?x) (link ?x ?y))", "(open ?y)", "?who - agent ?x ?y - thing"),
        predicates=LINKS,
        functions="(dist ?x ?y)",
    )
    distances = "(= (dist a b) 1) (= (dist a a) 1) (= (dist b a) 1) (= (dist b b) 1)"
    known = f"(at h a) (at r a) (open a) (link a b) {distances}"
    task = one(tmp_path, text, problem(known, "(at h b)", OBJECTS))
    assert len([a for a in task.actions if a.name.startswith("move")]) == 8
    less = known.replace("(= (dist b a) 1)", "")
    with pytest.raises(
        InputError, match=r"domain.pddl:5: action 'move h b a': no initial value of 'dist b a'"
    ):
        one(tmp_path, text, problem(less, "(at h b)", OBJECTS))


def test_waiting_and_what_nobody_does_need_no_cost(tmp_path: Path) -> None:
    text = domain(
        action("wait", "(and)", "(increase (total-cost) (far))"),
        "(:action rain :parameters () :precondition (q) :effect (and (p) (increase (total-cost) (far))))",
        action("go", "(q)", "(p) (increase (total-cost) 1)"),
        functions="(far)",
    )
    task = one(tmp_path, text, problem("(q)"))
    assert {a.name: a.cost for a in task.actions} == {"go h": 1, "go r": 1}
