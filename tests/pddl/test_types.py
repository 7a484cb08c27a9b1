"""Types of several names: what of one of them may be, may not be, and ranges over."""

from pathlib import Path

import pytest

from serendipity import InputError, Task
from serendipity.pddl.parsing.types import MAX_LEVELS, Types
from tests.pddl.texts import action, domain, names, one, problem

TYPES = "agent - object car truck - vehicle vehicle crate - thing thing"
OBJECTS = "h r - agent c - car t - truck b - crate"


def carried(folder: Path, parameter: str, predicate: str = "?x - thing", objects: str = OBJECTS) -> Task:
    text = domain(
        action("move", "(on ?x)", "(not (on ?x))", f"?who - agent {parameter}"),
        predicates=f"(on {predicate}) (p)",
        types=TYPES,
    )
    return one(folder, text, problem("(on c) (on t) (on b)", objects=objects))


def moved(task: Task) -> str:
    return " ".join(name.split()[-1] for name in names(task, "move h"))


@pytest.mark.parametrize(
    ("kind", "objects"),
    [
        ("(either car crate)", "b c"),
        ("(either vehicle crate)", "b c t"),
        ("(either truck)", "t"),
        ("(either car truck crate car)", "b c t"),
        ("(either object car)", "b c t"),
    ],
)
def test_a_parameter_ranges_over_each_of_its_types(tmp_path: Path, kind: str, objects: str) -> None:
    assert moved(carried(tmp_path, f"?x - {kind}")) == objects


def test_a_predicate_takes_each_of_its_types(tmp_path: Path) -> None:
    assert moved(carried(tmp_path, "?x - crate", "?x - (either crate vehicle)")) == "b"
    message = r"problem.pddl:4: initial state: 't' is of type 'truck', expected type '\(either crate car\)'"
    with pytest.raises(InputError, match=message):
        carried(tmp_path, "?x - crate", "?x - (either crate car)")


def test_an_object_of_several_types_is_of_what_all_of_them_are(tmp_path: Path) -> None:
    objects = "h r - agent c - (either car truck) t - truck b - (either crate car)"
    assert moved(carried(tmp_path, "?x - vehicle", objects=objects)) == "c t"
    assert moved(carried(tmp_path, "?x - car", objects=objects)) == ""
    assert moved(carried(tmp_path, "?x - (either crate car)", objects=objects)) == "b"


def test_types_may_be_above_each_other_in_several_ways() -> None:
    types = Types({"a": ("b", "c"), "b": ("d",), "c": ("d",), "d": ("object",), "e": ("object",)})
    assert types.is_subtype(("a",), ("d",))
    assert types.is_subtype(("a",), ("b", "c"))
    assert not types.is_subtype(("a",), ("b",))
    assert types.is_subtype(("a", "b"), ("d", "e"))
    assert types.comparable(("a",), ("b",))
    assert types.comparable(("d",), ("a", "e"))
    assert not types.comparable(("a",), ("e",))


@pytest.mark.parametrize(
    "types", ["a - b b - a", "a - (either b c) b - c c - b", "a - a", "b - object a - b b - a"]
)
def test_circles(tmp_path: Path, types: str) -> None:
    with pytest.raises(InputError, match=r"domain.pddl:2: type '\w' is (its own supertype|declared twice)"):
        one(tmp_path, domain(types=types), problem())


@pytest.mark.parametrize("above_first", [True, False])
def test_types_may_be_nested_only_so_deeply(tmp_path: Path, above_first: bool) -> None:
    def chain(levels: int) -> str:
        pairs = [f"t{i + 1} - t{i}" for i in range(levels)]
        return "agent t0 - object\n" + "\n".join(pairs if above_first else pairs[::-1])

    move = action("move", "(on ?x)", "(not (on ?x))", "?who - agent ?x - t0")
    goal = problem("(on c)", objects=f"h r - agent c - t{MAX_LEVELS - 1}")
    high = domain(move, predicates="(on ?x - t0) (p)", types=chain(MAX_LEVELS - 1))
    assert moved(one(tmp_path, high, goal)) == "c"
    for levels in (MAX_LEVELS, 50_000):
        higher = high.replace(chain(MAX_LEVELS - 1), chain(levels))
        with pytest.raises(InputError, match=r"domain.pddl:\d+: types are nested too deeply: at most 128"):
            one(tmp_path, higher, goal)


def test_ways_up_may_be_many(tmp_path: Path) -> None:
    """Two types on each level, both below both of the level above: more ways up than anybody can climb."""
    levels = "\n".join(f"a{i} b{i} - (either a{i - 1} b{i - 1})" for i in range(1, MAX_LEVELS))
    types = f"agent a0 b0 - object\n{levels}"
    many = domain(action("move", "(p)", "(p)", "?who - agent"), predicates="(p)", types=types)
    last = f"a{MAX_LEVELS - 1}"
    with pytest.raises(InputError, match=f"object 'c' is declared as 'agent' and as '{last}'"):
        one(tmp_path, many, problem("(p)", objects=f"h r - agent c - agent c - {last}"))
