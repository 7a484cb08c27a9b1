"""Ways to doctor a proof: each makes it prove nothing, or something else than its result claims."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from tests.verify.proofs.samples import Proof, sample
from tests.verify.scenarios.edit import edit, together

Doctor = Callable[[Proof], object]


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


def _program(path: str, value: object) -> Doctor:
    """Set something of the first program."""
    return edit(f"programs.0.{path}", value)


def _without(field: str) -> Doctor:
    return lambda proof: _first(proof).pop(field)


def _drop_every(family: str) -> Doctor:
    return _program("rows", lambda rows: [row for row in rows if row["family"] != family])


def _more_rows(proof: Proof) -> None:
    """A row that contradicts itself, and a leaf that needs nothing else."""
    program = _first(proof)
    program["rows"].append({"family": "eq. 3", "terms": [], "sense": "<=", "right": -1})
    program["tree"] = {"multipliers": [[len(program["rows"]) - 1, "1/1"]]}


def _multiply(row: int) -> Doctor:
    return lambda proof: _leaf(proof)["multipliers"].append([row, "1/1"])


def _leaf_text(text: str) -> Doctor:
    return lambda proof: _leaf(proof)["multipliers"][0].__setitem__(1, text)


_TURNED: Final = {"<=": ">=", ">=": "<=", "==": "=="}

DOCTORED: Final[dict[str, Doctored]] = {
    # numbers of a program
    "limit raised by one": Doctored("help", _program("limit", lambda limit: limit + 1)),
    "limit lowered": Doctored("help", _program("limit", lambda limit: limit - 1)),
    "limit lowered, without the solution": Doctored(
        "help", together(_program("limit", lambda limit: limit - 1), _without("solution")), alone=False
    ),
    "limit left out": Doctored("help", _without("limit")),
    "limit given where there is none": Doctored("no plan", _program("limit", 10), alone=False),
    "a row loosened": Doctored("branched", lambda p: _used_row(p, ">=").update(right=0)),
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
    "every sense turned": Doctored(
        "branched",
        _program("rows", lambda rows: [{**row, "sense": _TURNED[row["sense"]]} for row in rows]),
    ),
    "a row without a sense": Doctored("help", lambda p: _used_row(p).pop("sense")),
    "rows of a family left out": Doctored("branched", _drop_every("cover")),
    "robots free in the suffix": Doctored("help", _drop_every("eq. 8"), alone=False),
    "the goal dropped": Doctored("no help", _drop_every("eq. 3"), alone=False),
    "a contradiction added": Doctored("help", _more_rows, alone=False),
    "a column left out": Doctored("help", _program("columns", lambda old: old[:-1]), alone=False),
    "a column with a fraction": Doctored("help", _program("columns", lambda old: [*old, [0, 0.5]])),
    "all columns fixed": Doctored(
        "help", _program("columns", lambda old: [[0, 0] for _ in old]), alone=False
    ),
    "bounds of a column turned": Doctored("help", _program("columns.0", [1, 0])),
    "the objective doubled": Doctored(
        "no help", _program("objective", lambda terms: [[x, 2 * weight] for x, weight in terms]), alone=False
    ),
    "the objective left out": Doctored("help", _program("objective", [])),
    # the tree
    "a multiplier's sign": Doctored("branched", _flip_inequality),
    "multipliers halved": Doctored("branched", lambda p: _scale(p, "1/2", objective=False)),
    "the limit counted less": Doctored("branched", lambda p: _scale(p, "1/7", objective=True)),
    "the limit's sign": Doctored("branched", lambda p: _scale(p, "-1", objective=True)),
    "a multiplier with a denominator of zero": Doctored("branched", _leaf_text("1/0")),
    "a multiplier that is a float": Doctored("branched", _leaf_text("1.5")),
    "a leaf emptied": Doctored("branched", lambda p: _leaf(p).update(multipliers=[])),
    "a leaf dropped": Doctored("branched", lambda p: _first(p)["tree"].pop("up")),
    "one side for the whole": Doctored("branched", _program("tree", lambda tree: tree["down"])),
    "one side twice": Doctored("branched", _program("tree", lambda tree: {**tree, "up": tree["down"]})),
    "both sides changed": Doctored(
        "branched", _program("tree", lambda tree: {**tree, "up": tree["down"], "down": tree["up"]})
    ),
    "a branch's value raised": Doctored("branched", _program("tree.value", lambda value: value + 1)),
    "a branch's column shifted": Doctored("branched", _program("tree.branch", lambda column: column + 1)),
    "a branch on no column": Doctored("branched", _program("tree.branch", 10**6)),
    "a multiplier for no row": Doctored("branched", _multiply(10**6)),
    "the limit where there is none": Doctored("no plan", _multiply(-1)),
    "no tree": Doctored("help", _program("tree", {})),
    # the whole
    "a program missing": Doctored("two programs", edit("programs", lambda old: old[:-1]), alone=False),
    "programs swapped": Doctored("two programs", edit("programs", lambda old: old[::-1]), alone=False),
    "a program twice": Doctored("help", edit("programs", lambda old: [*old, *old]), alone=False),
    "no programs": Doctored("help", edit("programs", [])),
    "another schema": Doctored("help", edit("schema", "serendipity.proof/0")),
    "another claim": Doctored("help", edit("claim", "no_opportunity"), alone=False),
    "a claim that nobody makes": Doctored("help", edit("claim", "beautiful")),
    "another encoding": Doctored("help", edit("encoding", "paper"), alone=False),
    "another unit": Doctored("help", _program("unit", "1/1"), alone=False),
    "another name": Doctored("help", _program("name", "some windows"), alone=False),
    "another task's": Doctored("help", lambda p: p.update(sample("suffixes").proof), alone=False),
    "the same task's, in another mode": Doctored(
        "help", lambda p: p.update(sample("two programs").proof), alone=False
    ),
    # solutions and suffixes
    "a solution that is none": Doctored("given plan", _program("solution", lambda old: old[:-1])),
    "a solution left out": Doctored("given plan", _without("solution"), alone=False),
    "what suffixes cost left out": Doctored("suffixes", _without("suffixes"), alone=False),
    "a suffix from another epoch": Doctored("suffixes", _program("suffixes.0.epoch", 3), alone=False),
}
