"""Checks proof files with integers only: this one file, Python's standard library, and nothing else.

    python checker.py PROOF.json [PROOF.json.gz ...]

A proof is a list of integer programs.  A program has columns, each with a least and a greatest value,
and rows ``sum a x <= b`` (or ``>=``, ``==``).  It is refuted if no whole values of the columns satisfy all
rows and keep the objective at or below ``limit``; where ``limit`` is null, if no values satisfy the rows.

Why it is refuted is a tree.  A node with ``branch`` splits on a column: ``x <= value`` in ``down``,
``x >= value + 1`` in ``up``; whole values are on one side or the other.  A leaf has a multiplier for some
of the rows; row -1 is ``objective <= limit``.  A row ``<=`` may be multiplied by what is not negative, ``>=``
by what is not positive, ``==`` by anything, so whoever satisfies the rows satisfies their weighted sum
``sum a x <= b``.  A leaf holds if even the least value of ``sum a x``, within the bounds of the columns and
of the branches above, is greater than ``b``.  Where all leaves hold, nobody satisfies the program.

A program may have a ``solution``: values that satisfy the rows with the objective ``limit + 1``, which is
then its optimum.

What this does not say is that the programs are the right ones for a claim about a task.  For that,
``serendipity check-proof PROOF TASK RESULT`` makes them again and compares.
"""

import gzip
import json
import re
import sys
import zlib
from collections.abc import Callable, Iterator
from math import lcm
from pathlib import Path
from typing import Any, Final, NamedTuple, NoReturn

SCHEMA: Final = "serendipity.proof/1"
CLAIMS: Final = ("optimal", "no_opportunity", "lower_bound", "infeasible", "cost")
SENSES: Final = ("<=", ">=", "==")
_KINDS: Final[dict[type, str]] = {str: "a text", list: "a list", dict: "an object"}

MOST_BYTES: Final = 1 << 30  # of a file, unpacked
MOST: Final = 10**30  # the largest number of a program
MOST_BITS: Final = 1 << 16  # of the common denominator of a leaf
_MULTIPLIER: Final = re.compile(r"(-?[0-9]{1,60})/([0-9]{1,60})")

Terms = list[tuple[int, int]]  # a column and its coefficient
Row = tuple[Terms, str, int]  # terms, sense, right-hand side
Bounds = dict[int, tuple[int, int]]  # least and greatest value, by column


class MalformedProofError(ValueError):
    """A file is no proof file; the text says what was expected."""


class RejectedProofError(ValueError):
    """A proof proves nothing; the text says where it fails."""


class Program(NamedTuple):
    """One program of a proof; ``tree`` is what the file says, looked at where it is checked."""

    name: str
    columns: list[tuple[int, int]]
    objective: Terms
    limit: int | None
    rows: list[Row]
    solution: Terms | None
    tree: Any


class Checked(NamedTuple):
    """What is known of a program that is refuted; ``optimum`` where it has a solution."""

    name: str
    columns: int
    rows: int
    leaves: int
    limit: int | None
    optimum: int | None


def check(data: Any, each: Callable[..., Any] = iter) -> list[Checked]:
    """Check a proof; returning means that every program is refuted.

    Args:
        data: what :func:`read` has read.
        each: goes through rows and leaves, and may end it all by an error.

    Raises:
        MalformedProofError: it is no proof.
        RejectedProofError: it does not hold.
    """
    if (schema := _field(data, "schema", str, "proof")) != SCHEMA:
        _malformed(f"schema: expected '{SCHEMA}', got {schema!r:.50}")
    if _field(data, "claim", str, "proof") not in CLAIMS:
        _malformed(f"claim: expected one of {', '.join(CLAIMS)}")
    given = _field(data, "programs", list, "proof") or _malformed("programs: expected at least one")
    return [refute(program(one, f"program {k}", each), each) for k, one in enumerate(given)]


def refute(program: Program, each: Callable[..., Any] = iter) -> Checked:
    """Check one program's tree, leaf by leaf, and its solution.

    Raises:
        MalformedProofError: the tree is none.
        RejectedProofError: a leaf does not hold, or the solution is none.
    """
    leaves = 0
    for leaves, (leaf, bounds) in enumerate(each(_leaves(program)), 1):
        if not _holds(program, leaf, bounds, each):
            raise RejectedProofError(f"{program.name}: leaf {leaves} leaves something")
    optimum = None if program.solution is None else _optimum(program, dict(program.solution), each)
    return Checked(program.name, len(program.columns), len(program.rows), leaves, program.limit, optimum)


def _leaves(program: Program) -> Iterator[tuple[list[Any], Bounds]]:
    """The multipliers of each leaf, with the bounds that the branches above it set."""
    waiting: list[tuple[Any, Bounds]] = [(program.tree, {})]
    while waiting:
        node, bounds = waiting.pop()
        if type(node) is dict and node.keys() == {"multipliers"} and type(node["multipliers"]) is list:
            yield node["multipliers"], bounds
        elif type(node) is dict and node.keys() == {"branch", "value", "down", "up"}:
            x, value = _number(node["branch"], "branch"), _number(node["value"], "value")
            if not 0 <= x < len(program.columns):
                _malformed(f"{program.name}: tree: there is no column {x}")
            least, greatest = bounds.get(x, program.columns[x])
            if not least <= value < greatest:
                raise RejectedProofError(f"{program.name}: tree: column {x} can't be split at {value}")
            waiting.append((node["up"], bounds | {x: (value + 1, greatest)}))
            waiting.append((node["down"], bounds | {x: (least, value)}))
        else:
            _malformed(f"{program.name}: tree: expected multipliers, or branch, value, down and up")


def _holds(program: Program, leaf: list[Any], bounds: Bounds, each: Callable[..., Any]) -> bool:
    """Whether the weighted sum of rows is out of reach within the bounds."""
    weights = [_weight(program, one) for one in leaf]
    scale = 1
    for _, _, denominator in weights:
        scale = lcm(scale, denominator)
        if scale.bit_length() > MOST_BITS:
            _malformed(f"{program.name}: tree: expected denominators with a smaller common multiple")
    limit: Row = program.objective, "<=", program.limit or 0
    sums: dict[int, int] = {}
    right = 0
    for number, numerator, denominator in each(weights):
        factor = numerator * (scale // denominator)
        terms, sense, side = program.rows[number] if number >= 0 else limit
        if (sense == "<=" and factor < 0) or (sense == ">=" and factor > 0):
            raise RejectedProofError(f"{program.name}: tree: row {number} has a multiplier of the wrong sign")
        right += factor * side
        for x, coefficient in terms:
            sums[x] = sums.get(x, 0) + factor * coefficient
    least = 0
    for x, total in sums.items():
        low, high = bounds.get(x, program.columns[x])
        least += total * (low if total > 0 else high)
    return least > right


def _weight(program: Program, data: Any) -> tuple[int, int, int]:
    """A multiplier: row, numerator, denominator."""
    if type(data) is not list or len(data) != 2 or type(data[1]) is not str:
        _malformed(f'{program.name}: tree: expected multipliers [row, "numerator/denominator"]')
    number, text = _number(data[0], "multipliers"), _MULTIPLIER.fullmatch(data[1])
    if text is None or not int(text[2]):
        _malformed(f"{program.name}: tree: expected numerator/denominator, got {data[1][:40]!r}")
    if not (0 if program.limit is None else -1) <= number < len(program.rows):
        _malformed(f"{program.name}: tree: there is no row {number}")
    return number, int(text[1]), int(text[2])


def _optimum(program: Program, values: dict[int, int], each: Callable[..., Any]) -> int:
    """The objective of a solution, which has to be one more than what is refuted."""
    for x, (least, greatest) in enumerate(program.columns):
        if not least <= values.get(x, 0) <= greatest:
            raise RejectedProofError(f"{program.name}: solution: column {x} is out of bounds")
    for number, (terms, sense, right) in enumerate(each(program.rows)):
        total = sum(coefficient * values.get(x, 0) for x, coefficient in terms)
        if (total > right and sense != ">=") or (total < right and sense != "<="):
            raise RejectedProofError(f"{program.name}: solution: row {number} does not hold")
    objective = sum(coefficient * values.get(x, 0) for x, coefficient in program.objective)
    if program.limit is None or objective != program.limit + 1:
        raise RejectedProofError(f"{program.name}: solution: the objective is {objective}, not limit + 1")
    return objective


def program(data: Any, where: str, each: Callable[..., Any] = iter) -> Program:
    """One program of a proof.

    Args:
        data: as JSON has it.
        where: what errors call it.

    Raises:
        MalformedProofError: something is missing, or is of another type.
    """
    columns = []
    for bounds in _field(data, "columns", list, where):
        least, greatest = _pair(bounds, f"{where}: columns")
        columns.append((least, greatest))
        if least > greatest:
            _malformed(f"{where}: columns: expected the least value before the greatest")
    rows = []
    for row in each(_field(data, "rows", list, where)):
        if _field(row, "sense", str, where) not in SENSES:
            _malformed(f"{where}: rows: expected one of {', '.join(SENSES)}")
        terms = _terms(row, "terms", where, len(columns))
        rows.append((terms, row["sense"], _field(row, "right", int, where)))
    unlimited = data.get("limit", 0) is None
    return Program(
        _field(data, "name", str, where),
        columns,
        _terms(data, "objective", where, len(columns)),
        None if unlimited else _field(data, "limit", int, where),
        rows,
        _terms(data, "solution", where, len(columns)) if "solution" in data else None,
        _field(data, "tree", dict, where),
    )


def _terms(data: Any, name: str, where: str, columns: int) -> Terms:
    """A list of ``[column, integer]``, each column at most once."""
    found: dict[int, int] = {}
    for pair in _field(data, name, list, where):
        x, number = _pair(pair, f"{where}: {name}")
        if not 0 <= x < columns or x in found:
            _malformed(f"{where}: {name}: expected each column below {columns} at most once, got {x}")
        found[x] = number
    return list(found.items())


def _pair(value: Any, where: str) -> tuple[int, int]:
    if type(value) is not list or len(value) != 2:
        _malformed(f"{where}: expected pairs of integers")
    return _number(value[0], where), _number(value[1], where)


def _field(data: Any, name: str, kind: type, where: str) -> Any:
    if type(data) is not dict or name not in data:
        _malformed(f"{where}: expected an object with '{name}'")
    if kind is not int and type(data[name]) is not kind:
        _malformed(f"{where}: {name}: expected {_KINDS[kind]}")
    return _number(data[name], f"{where}: {name}") if kind is int else data[name]


def _number(value: Any, where: str) -> int:
    if type(value) is not int or not -MOST <= value <= MOST:
        _malformed(f"{where}: expected an integer within 10^30, got {str(value)[:40]}")
    return value


def _malformed(message: str) -> NoReturn:
    raise MalformedProofError(message)


def read(path: Path, each: Callable[..., Any] = iter) -> Any:
    """The JSON value in a file, which may be packed by gzip.

    Raises:
        MalformedProofError: it can't be read, or holds something else.
    """
    try:
        with path.open("rb") as file:
            packed = file.read(2) == b"\x1f\x8b"
        with gzip.open(path) if packed else path.open("rb") as content:
            text = content.read(MOST_BYTES + 1)
        if len(text) > MOST_BYTES:
            _malformed(f"expected no more than {MOST_BYTES:,} bytes")
        return json.loads(text.decode("utf-8-sig"), object_pairs_hook=lambda pairs: _object([*each(pairs)]))
    except MalformedProofError:
        raise
    except (EOFError, zlib.error, gzip.BadGzipFile):
        _malformed("expected a whole gzip file")
    except OSError as error:
        _malformed(f"can't be read: {error.strerror or error}")
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        _malformed(f"expected JSON in UTF-8: {error}")
    except (RecursionError, ValueError):
        _malformed("expected JSON: it is nested too deeply, or has a number of thousands of digits")


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    return found if len(found) == len(pairs) else _malformed("expected each field of an object once")


def main(files: list[str]) -> int:
    """Check files, and print a line for each: 0 if all hold, 1 if one does not, 2 if one is no proof."""
    code = 0
    for file in files:
        try:
            print(f"{file}: holds, {sum(found.leaves for found in check(read(Path(file))))} leaves")
        except (RejectedProofError, MalformedProofError) as error:
            print(f"{file}: {error}")
            code = max(code, 2 if isinstance(error, MalformedProofError) else 1)
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
