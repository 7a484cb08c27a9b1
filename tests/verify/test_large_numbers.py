"""Costs, discounts and weights may be any rationals: whatever they are, false claims are not proved."""

import json
from itertools import combinations_with_replacement, pairwise
from pathlib import Path
from random import Random
from typing import Any

import pytest

import serendipity
from serendipity.model import Options, Task
from serendipity_testing.builders import task as build
from serendipity_testing.crosscheck.doctored import without_plan
from serendipity_testing.oracle import Alone, Moment
from serendipity_testing.pseudo_boolean.comparison import difference
from serendipity_testing.pseudo_boolean.question import NotMadeError
from tests.verify.denied import denied
from verify.base.small_numbers import OrderOfSums
from verify.limits import limited
from verify.programs.alone import least_alone
from verify.programs.effort import Effort

METHODS = ("auto", "exhaustive", "program")


def helped(price: str = "1", his: str = "5") -> Task:
    """A robot's action for some price saves the human 4."""
    actions = {"do h": f"-> g @ {his}", "quick h": "q -> g @ 1", "open r": f"-> q @ {price}"}
    return build(agents="h r", human="h", goal="g", actions=actions)


HELPED: list[tuple[Task, dict[str, Any]]] = [
    (helped(), {"discount": "0.666666666667"}),
    (helped("1.000000001"), {"discount": "0.5", "window_weight": 1000}),
    (helped("1.000000001"), {"discount": "0", "window_weight": 1200}),
    (helped("1.000000001"), {"discount": "0", "window_weight": 10**9}),
    (helped("83/130", "9984/973"), {"discount": "997/1012", "window_weight": "67/70"}),
    (helped("0.000000001", "1000000000000000"), {"discount": "1/3", "window_weight": "0"}),
    (helped("1", "1000000000000000"), {"discount": "0.123456789012345", "window_weight": "1/7"}),
]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("number", range(len(HELPED)))
def test_help_is_not_denied(number: int, method: str) -> None:
    task, options = HELPED[number]
    options = {"horizon": 2, **options}
    right = serendipity.plan(task, **options)
    assert right.opportunity
    honest = serendipity.verify(task, right, method=method).verdict
    false = serendipity.verify(task, denied(task, right), method=method).verdict
    if method == "program" and number in (4, 6):  # it may have too many digits for a solver
        assert honest != "refuted" and false != "proved"
    else:
        assert (honest, false) == ("proved", "refuted")


@pytest.mark.long
@pytest.mark.parametrize(
    "sizes", [{"weight": 10**6, "coefficient": 10**3}, {"weight": 0}, {"coefficient": 0}]
)
@pytest.mark.parametrize("number", range(len(HELPED)))
def test_where_words_are_too_small_nothing_false_is_proved(number: int, sizes: dict[str, int]) -> None:
    task, options = HELPED[number]
    right = serendipity.plan(task, horizon=2, **options)
    lie = denied(task, right)
    with limited(**sizes, many_moves=0, many_actions=0):
        for method in METHODS:
            assert serendipity.verify(task, lie, method=method).verdict != "proved"
            assert serendipity.verify(task, right, method=method).verdict != "refuted"


def test_a_proof_is_written_and_checked_of_small_numbers(tmp_path: Any) -> None:
    task, file = helped("1.000000001"), tmp_path / "proof.json"
    right = serendipity.plan(task, discount="0.5", horizon=2)
    assert serendipity.verify(task, right, proof=file).verdict == "proved"
    assert serendipity.check_proof(file, task, right).verdict == "accepted"
    lie = denied(task, right)
    assert serendipity.check_proof(file, task, lie).verdict == "rejected"


_PRICES = ("1", "1.000000001", "2", "2.000000003")

_ALONE = {"a h": "-> s @ 1.0000001", "b h": "s -> p @ 2", "c h": "-> p @ 3.0000002", "help r": "-> s"}


def test_what_the_human_costs_alone_has_a_proof_of_small_numbers(tmp_path: Path) -> None:
    task, file = build(goal="p", actions=_ALONE), tmp_path / "proof.json"
    right = serendipity.plan(task, mode="individual")
    assert serendipity.verify(task, right, proof=file).verdict == "proved"
    assert serendipity.check_proof(file, task, right).verdict == "accepted"
    (program,) = json.loads(file.read_bytes())["programs"]
    assert program["unit"].startswith("none: ")
    with pytest.raises(NotMadeError, match="unit none"):
        difference(task, right, program, lambda _: 0)
    cheaper = build(goal="p", actions={**_ALONE, "c h": "-> p @ 3.0000000"})
    assert serendipity.verify(cheaper, right, proof=tmp_path / "none.json").verdict == "refuted"
    assert serendipity.check_proof(file, cheaper, right).verdict == "rejected"


def test_that_the_human_has_no_plan_has_a_proof_of_small_numbers(tmp_path: Path) -> None:
    task = build(goal="p", actions={**_ALONE, "b h": "n -> p @ 2/1000003", "c h": "s -> o @ 7/999999937"})
    file = tmp_path / "proof.json"
    answer = serendipity.plan(task)
    assert answer.status == "infeasible"
    assert serendipity.verify(task, answer, proof=file).verdict == "proved"
    assert serendipity.check_proof(file, task, answer).verdict == "accepted"


@pytest.mark.parametrize("seed", range(8))
def test_least_costs_alone_are_exact_whatever_their_digits(seed: int) -> None:
    dice = Random(seed)
    roads = {"help r": "-> v1"}
    for number in range(9):
        source, target = dice.sample(range(5), 2)
        roads[f"go{number} h"] = f"v{source} -> v{target} !v{source} @ {dice.choice(_PRICES)}"
    task = build(init="v0", goal="v4", actions=roads)
    worth = Alone(task).worth(Moment(task.init))
    found = least_alone(task, Options(mode="individual"), Effort(method="program"))
    assert found == (None if worth is None else worth[0])


DEAR = [("2000000", "0.000000001"), ("2000000000000000", "1"), ("1000000000000000", "1/999999999999989")]


@pytest.mark.parametrize(("dear", "small"), DEAR)
@pytest.mark.parametrize(
    "options",
    [
        {"mode": "composite", "horizon": "inf"},
        {"mode": "composite", "horizon": 2},
        {"mode": "communication", "horizon": 2},
    ],
)
def test_what_is_dear_is_possible(dear: str, small: str, options: dict[str, Any]) -> None:
    actions = {"j h r": f"-> g @ {dear}", "b r": f"g -> q @ {small}"}
    task = build(agents="h r", human="h", goal="g", actions=actions)
    right = serendipity.plan(task, **options)
    reason = "no-plan" if options["horizon"] == "inf" else "no-plan-within-horizon"
    lie = without_plan(right, "infeasible", reason)
    methods = METHODS[:2] if options["horizon"] == "inf" else METHODS
    for method in methods:
        assert serendipity.verify(task, right, method=method).verdict == "proved"
        assert serendipity.verify(task, lie, method=method).verdict == "refuted"


@pytest.mark.parametrize("method", ["auto", "exhaustive"])
def test_a_limit_on_cost_is_none_on_communication(method: str) -> None:
    """Help costs 2, and 4 with what is said; doing nothing costs 5."""
    switches = {f"set{k} r": f"-> t{k} @ 0" for k in range(4)}
    actions = {"do h": "-> g @ 5", "quick h": "q -> g @ 1", "open r": "t0 t1 t2 t3 -> q @ 1", **switches}
    task = build(agents="h r", human="h", goal="g", actions=actions)
    options = {"mode": "communication", "communication_weight": 2, "max_cost": 2, "horizon": 7}
    right = serendipity.plan(task, **options)
    assert (right.cost, right.objective, right.opportunity) == (2, 4, True)
    with limited(few_states=1, methods=("-programs",)):
        assert serendipity.verify(task, right, method=method).verdict != "refuted"
        lie = denied(task, right)
        assert serendipity.verify(task, lie, method=method).verdict == "refuted"


@pytest.mark.parametrize("seed", range(60))
def test_small_numbers_keep_the_order_of_sums(seed: int) -> None:
    dice = Random(seed)
    unit, terms = 10 ** dice.randint(3, 15), dice.randint(1, 4)
    near = [
        unit * dice.randint(1, 9) // dice.choice([1, 3, 7]) + dice.choice([0, 0, 1, 40]) for _ in range(3)
    ]
    numbers = [*near, dice.choice([1, unit, 1000 * unit])]
    order = OrderOfSums.of(frozenset(numbers), 2 * terms)
    some = [each for count in range(terms + 1) for each in combinations_with_replacement(numbers, count)]
    sums = sorted({(sum(each), sum(map(order, each))) for each in some})
    for (one, small), (other, large) in pairwise(sums):
        assert (one < other) == (small < large)
    for one, small in sums:
        assert order.bound(small) == one
        for limit in (one, one - 1, one + dice.randint(-unit, unit)):
            assert [s <= order.limit(limit) for _, s in sums] == [each <= limit for each, _ in sums]
            bound = order.limit(limit) + 1
            assert all(each >= order.bound(bound) for each, s in sums if s >= bound)
