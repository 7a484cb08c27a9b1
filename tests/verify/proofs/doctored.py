"""Ways to doctor a proof: each makes it prove nothing, or something else than its result claims."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from tests.verify.proofs.samples import Proof, sample

Doctor = Callable[[Proof], None]


@dataclass(frozen=True, slots=True)
class Doctored:
    """A way to doctor a sample.

    Attributes:
        sample: by name.
        change: what is done to the proof.
        alone: whether the file alone shows it; else task and result do.
    """

    sample: str
    change: Doctor
    alone: bool = True


def _first(proof: Proof) -> Any:
    return proof["programs"][0]


def _nodes(node: Any) -> Iterator[Any]:
    yield node
    for side in ("down", "up"):
        if side in node:
            yield from _nodes(node[side])


def _leaf(proof: Proof) -> Any:
    """The leaf with the most multipliers."""
    leaves = (node for node in _nodes(_first(proof)["tree"]) if "multipliers" in node)
    return max(leaves, key=lambda leaf: len(leaf["multipliers"]))


def _used_row(proof: Proof, sense: str = "") -> Any:
    """A row that a leaf needs."""
    rows = _first(proof)["rows"]
    return next(
        rows[row]
        for row, _ in _leaf(proof)["multipliers"]
        if row >= 0 and rows[row]["terms"] and (not sense or rows[row]["sense"] == sense)
    )


def _unused_row(proof: Proof) -> Any:
    used = {row for row, _ in _leaf(proof)["multipliers"]}
    return next(row for k, row in enumerate(_first(proof)["rows"]) if k not in used and row["terms"])


def _scale(proof: Proof, factor: str, *, objective: bool) -> None:
    for pair in _leaf(proof)["multipliers"]:
        if (pair[0] == -1) == objective:
            pair[1] = f"{Fraction(pair[1]) * Fraction(factor)}"
            pair[1] += "" if "/" in pair[1] else "/1"


def _flip_inequality(proof: Proof) -> None:
    rows = _first(proof)["rows"]
    pair = next(p for p in _leaf(proof)["multipliers"] if p[0] >= 0 and rows[p[0]]["sense"] != "==")
    pair[1] = pair[1].removeprefix("-") if pair[1].startswith("-") else f"-{pair[1]}"


def _loosen(proof: Proof) -> None:
    row = _used_row(proof, ">=")
    row["right"] -= 1


def _flip_sense(proof: Proof) -> None:
    for row in _first(proof)["rows"]:
        row["sense"] = {"<=": ">=", ">=": "<=", "==": "=="}[row["sense"]]


def _drop_every(family: str) -> Doctor:
    def drop(proof: Proof) -> None:
        program = _first(proof)
        kept = [row for row in program["rows"] if row["family"] != family]
        assert len(kept) < len(program["rows"])
        program["rows"] = kept

    return drop


def _move_branch(column: int, value: int) -> Doctor:
    def move(proof: Proof) -> None:
        tree = _first(proof)["tree"]
        tree["branch"] += column
        tree["value"] += value

    return move


def _without_branch(proof: Proof) -> None:
    """One side stands for the whole."""
    _first(proof)["tree"] = _first(proof)["tree"]["down"]


def _same_side_twice(proof: Proof) -> None:
    tree = _first(proof)["tree"]
    tree["up"] = tree["down"]


def _sides_changed(proof: Proof) -> None:
    tree = _first(proof)["tree"]
    tree["up"], tree["down"] = tree["down"], tree["up"]


def _drop_side(proof: Proof) -> None:
    del _first(proof)["tree"]["up"]


def _empty_leaf(proof: Proof) -> None:
    _leaf(proof)["multipliers"] = []


def _swap_programs(proof: Proof) -> None:
    proof["programs"].reverse()


def _tighter_columns(proof: Proof) -> None:
    """All columns at zero: the program is no longer the claim's, whatever refutes it."""
    program = _first(proof)
    program["columns"] = [[0, 0] for _ in program["columns"]]


def _more_rows(proof: Proof) -> None:
    """A row that contradicts itself, and a leaf that needs nothing else."""
    program = _first(proof)
    program["rows"].append({"family": "eq. 3", "terms": [], "sense": "<=", "right": -1})
    program["tree"] = {"multipliers": [[len(program["rows"]) - 1, "1/1"]]}


def _dearer_objective(proof: Proof) -> None:
    for term in _first(proof)["objective"]:
        term[1] *= 2


def _lower_limit(proof: Proof) -> None:
    _first(proof)["limit"] -= 1


def _lower_limit_without_solution(proof: Proof) -> None:
    _first(proof)["limit"] -= 1
    del _first(proof)["solution"]


def _set(**fields: Any) -> Doctor:
    return lambda proof: _first(proof).update(fields)


def _top(**fields: Any) -> Doctor:
    return lambda proof: proof.update(fields)


def _another_proof(name: str) -> Doctor:
    def replace(proof: Proof) -> None:
        proof.update(sample(name).proof)

    return replace


def _wrong_solution(proof: Proof) -> None:
    _first(proof)["solution"].pop()


def _multiply(proof: Proof, row: int, text: str) -> None:
    _leaf(proof)["multipliers"].append([row, text])


def _leaf_text(text: str) -> Doctor:
    def change(proof: Proof) -> None:
        _leaf(proof)["multipliers"][0][1] = text

    return change


DOCTORED: Final[dict[str, Doctored]] = {
    # numbers of a program
    "limit raised by one": Doctored("help", lambda p: _set(limit=_first(p)["limit"] + 1)(p)),
    "limit lowered": Doctored("help", _lower_limit),
    "limit lowered, without the solution": Doctored("help", _lower_limit_without_solution, alone=False),
    "limit left out": Doctored("help", lambda p: _first(p).pop("limit") and None),
    "limit given where there is none": Doctored("no plan", _set(limit=10), alone=False),
    "a row loosened": Doctored("branched", _loosen),
    "a row that is needed changed": Doctored("help", lambda p: _used_row(p).update(right=10**6), alone=False),
    "a row that is not needed changed": Doctored(
        "help", lambda p: _unused_row(p).update(right=10**6), alone=False
    ),
    "a coefficient changed": Doctored(
        "help", lambda p: _used_row(p)["terms"][0].__setitem__(1, 7), alone=False
    ),
    "a row's column changed": Doctored(
        "help",
        lambda p: _unused_row(p)["terms"][0].__setitem__(0, len(_first(p)["columns"]) - 1),
        alone=False,
    ),
    "every sense turned": Doctored("branched", _flip_sense),
    "a row without a sense": Doctored("help", lambda p: _used_row(p).pop("sense") and None),
    "rows of a family left out": Doctored("branched", _drop_every("cover")),
    "robots free in the suffix": Doctored("help", _drop_every("eq. 8"), alone=False),
    "the goal dropped": Doctored("no help", _drop_every("eq. 3"), alone=False),
    "a contradiction added": Doctored("help", _more_rows, alone=False),
    "a column left out": Doctored("help", lambda p: _first(p)["columns"].pop() and None, alone=False),
    "a column with a fraction": Doctored("help", lambda p: _first(p)["columns"].append([0, 0.5])),
    "all columns fixed": Doctored("help", _tighter_columns, alone=False),
    "bounds of a column turned": Doctored("help", lambda p: _first(p)["columns"].__setitem__(0, [1, 0])),
    "the objective doubled": Doctored("no help", _dearer_objective, alone=False),
    "the objective left out": Doctored("help", _set(objective=[])),
    # the tree
    "a multiplier's sign": Doctored("branched", _flip_inequality),
    "multipliers halved": Doctored("branched", lambda p: _scale(p, "1/2", objective=False)),
    "the limit counted less": Doctored("branched", lambda p: _scale(p, "1/7", objective=True)),
    "the limit's sign": Doctored("branched", lambda p: _scale(p, "-1", objective=True)),
    "a multiplier with a denominator of zero": Doctored("branched", _leaf_text("1/0")),
    "a multiplier that is a float": Doctored("branched", _leaf_text("1.5")),
    "a leaf emptied": Doctored("branched", _empty_leaf),
    "a leaf dropped": Doctored("branched", _drop_side),
    "one side for the whole": Doctored("branched", _without_branch),
    "one side twice": Doctored("branched", _same_side_twice),
    "both sides changed": Doctored("branched", _sides_changed),
    "a branch's value raised": Doctored("branched", _move_branch(0, 1)),
    "a branch's column shifted": Doctored("branched", _move_branch(1, 0)),
    "a branch on no column": Doctored("branched", _move_branch(10**6, 0)),
    "a multiplier for no row": Doctored("branched", lambda p: _multiply(p, 10**6, "1/1")),
    "the limit where there is none": Doctored("no plan", lambda p: _multiply(p, -1, "1/1")),
    "no tree": Doctored("help", _set(tree={})),
    # the whole
    "a program missing": Doctored("two programs", lambda p: p["programs"].pop() and None, alone=False),
    "programs swapped": Doctored("two programs", _swap_programs, alone=False),
    "a program twice": Doctored("help", lambda p: p["programs"].append(_first(p)), alone=False),
    "no programs": Doctored("help", _top(programs=[])),
    "another schema": Doctored("help", _top(schema="serendipity.proof/0")),
    "another claim": Doctored("help", _top(claim="no_opportunity"), alone=False),
    "a claim that nobody makes": Doctored("help", _top(claim="beautiful")),
    "another encoding": Doctored("help", _top(encoding="paper"), alone=False),
    "another unit": Doctored("help", _set(unit="1/1"), alone=False),
    "another name": Doctored("help", _set(name="some windows"), alone=False),
    "another task's": Doctored("help", _another_proof("suffixes"), alone=False),
    "the same task's, in another mode": Doctored("help", _another_proof("two programs"), alone=False),
    # solutions and suffixes
    "a solution that is none": Doctored("given plan", _wrong_solution),
    "a solution left out": Doctored("given plan", lambda p: _first(p).pop("solution") and None, alone=False),
    "what suffixes cost left out": Doctored(
        "suffixes", lambda p: _first(p).pop("suffixes") and None, alone=False
    ),
    "a suffix from another epoch": Doctored(
        "suffixes", lambda p: _first(p)["suffixes"][0].update(epoch=3), alone=False
    ),
}
