"""Proofs in the field's form: each program as OPB, and why it is refuted as a proof for VeriPB.

A proof that is written to ``help.pbp`` has three files for its first program, and with ``-2``, ``-3`` ... in
the name for each that follows:

* ``help.opb``: the rows as they are, ``x1`` for column 0, and either ``min:`` with the objective, where the
  optimum is shown by a solution, or the row ``objective <= limit`` behind all others;
* ``help.pbp``: a proof of version 2.0, which concludes that the optimum is what the solution has, or that
  nothing satisfies the rows;
* ``help.v1.pbp``: the same steps for checkers of version 1.1.

A leaf is one cutting-planes step, its multipliers made whole by their common denominator.  Below branches
it only says that they cannot all be taken, which reverse unit propagation sees; and so it does, node by
node, that neither side of a branch can be taken, until nothing is left.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from glob import escape
from math import lcm
from pathlib import Path
from typing import Any, Final, NamedTuple

from serendipity.model import UsageError
from serendipity.writing.together import write_together

SUFFIX: Final = ".pbp"
"""How the name of a proof in this form ends."""

Terms = Iterable[tuple[int, int]]
"""Columns and coefficients."""


class _Version(NamedTuple):
    """What differs between versions of the form: how files end, and the step that is a solution."""

    number: str
    suffix: str
    solution: str


_VERSIONS: Final = (_Version("2.0", ".pbp", "soli"), _Version("1.1", ".v1.pbp", "o"))

_FORMULA: Final = ".opb"

_HEAD: Final = 1000
"""Characters at the beginning of a problem that say whose it is."""

_SUFFIXES: Final = (_FORMULA, *(version.suffix for version in _VERSIONS))


def write(path: Path, proof: Mapping[str, Any]) -> None:
    """Write a proof's files, and remove those that an earlier proof of more programs has left beyond them.

    Raises:
        UsageError: a column has other values than 0 and 1.
        OSError: the system refuses.
    """
    files = in_the_fields_form(path, proof)
    write_together(files)
    for formula in path.parent.glob(f"{escape(path.stem)}-*{_FORMULA}"):
        if formula not in files and _is_further(formula, path):
            for suffix in _SUFFIXES:
                formula.with_suffix(suffix).unlink(missing_ok=True)


def _is_further(formula: Path, path: Path) -> bool:
    """Whether a file says of itself that it is the program that its name numbers, of a proof at a path."""
    number = formula.stem.removeprefix(f"{path.stem}-")
    ours = rf"\* #variable= \d+ #constraint= \d+\n\* [a-z_]+, program {re.escape(number)} of \d+: "
    try:
        with formula.open(encoding="utf-8", errors="replace") as file:
            return number.isdecimal() and bool(re.match(ours, file.read(_HEAD)))
    except OSError:
        return False


def in_the_fields_form(path: Path, proof: Mapping[str, Any]) -> dict[Path, bytes]:
    """The files of a proof, by name.

    Args:
        path: the first program's proof; its name ends in ``.pbp``.
        proof: the JSON object of a proof file, which its checker accepts.

    Raises:
        UsageError: a column has other values than 0 and 1.
    """
    files: dict[Path, bytes] = {}
    for number, program in enumerate(proof["programs"], 1):
        for x, (low, high) in enumerate(program["columns"]):
            if low < 0 or high > 1:
                words = f"OPB knows 0 and 1, column {x} is in {low} to {high}"
                raise UsageError(f"proof: {program['name']}: {words}")
        about = f"{proof['claim']}, program {number} of {len(proof['programs'])}"
        refutation = _Refutation(program)
        place = path if number == 1 else path.with_stem(f"{path.stem}-{number}")
        files[place.with_suffix(_FORMULA)] = _text(refutation.formula(about))
        for version in _VERSIONS:
            files[place.with_suffix(version.suffix)] = _text(refutation.proof(version))
    return files


def is_of(file: Path, path: Path) -> bool:
    """Whether a file's name is one that a proof has which is written to ``path``."""
    ends = "|".join(map(re.escape, _SUFFIXES))
    return file.parent == path.parent and bool(
        re.fullmatch(rf"{re.escape(path.stem)}(-\d+)?({ends})", file.name)
    )


def _text(lines: Iterator[str]) -> bytes:
    return "\n".join((*lines, "")).encode()


class _Refutation:
    """One program, its constraints numbered as VeriPB counts them: an equality is two, first ``>=``."""

    def __init__(self, program: Mapping[str, Any]) -> None:
        self._program = program
        self._limit: int | None = program["limit"]
        self._optimal = "solution" in program and bool(program["objective"])
        self._rows = [(row["terms"], row["sense"], row["right"], row["family"]) for row in program["rows"]]
        columns = enumerate(program["columns"])
        self._rows += [([(x, 1)], "==", low, "bounds") for x, (low, high) in columns if low == high]
        if self._limit is not None and not self._optimal:
            self._rows.append((program["objective"], "<=", self._limit, "objective <= limit"))
        self._first = [1]
        for _, sense, _, _ in self._rows:
            self._first.append(self._first[-1] + (2 if sense == "==" else 1))

    def formula(self, about: str) -> Iterator[str]:
        """The lines of the OPB file."""
        program = self._program
        yield f"* #variable= {len(program['columns'])} #constraint= {len(self._rows)}"
        yield f"* {about}: {program['name']}"
        yield f"* what an objective of 1 costs: {program.get('unit', 'not said')}"
        if self._optimal:
            yield f"min: {_sum(program['objective'])};"
        named = ""
        for terms, sense, right, family in self._rows:
            if family != named:
                yield f"* {family}"
                named = family
            sign = -1 if sense == "<=" else 1
            relation = "=" if sense == "==" else ">="
            yield f"{_sum((x, sign * a) for x, a in terms)}{relation} {sign * right} ;"

    def proof(self, version: _Version) -> Iterator[str]:
        """The lines of a proof."""
        last = self._first[-1] - 1
        yield f"pseudo-Boolean proof version {version.number}"
        yield f"f {last}"
        if self._optimal:
            chosen = {x for x, value in self._program["solution"] if value}
            signs = ("" if x in chosen else "~" for x in range(len(self._program["columns"])))
            yield " ".join((version.solution, *(f"{sign}x{x}" for x, sign in enumerate(signs, 1))))
            last += 1
        for line in self._steps(self._program["tree"], ()):
            yield line
            last += 1
        if version.number == "1.1":
            yield f"c {last}"
            return
        best = (self._limit or 0) + 1
        yield "output NONE"
        yield f"conclusion BOUNDS {best} : {last} {best}" if self._optimal else f"conclusion UNSAT : {last}"
        yield "end pseudo-Boolean proof"

    def _steps(self, node: Mapping[str, Any], taken: tuple[str, ...]) -> Iterator[str]:
        """The steps up to: not all of the branches above are taken; ``taken`` is true where they are not."""
        if "multipliers" in node:
            yield f"pol {self._combination(node['multipliers'])}"
        else:
            name = f"x{node['branch'] + 1}"
            yield from self._steps(node["down"], (*taken, name))
            yield from self._steps(node["up"], (*taken, f"~{name}"))
        yield " ".join(("rup", *(f"1 {literal}" for literal in taken), ">= 1 ;"))

    def _combination(self, multipliers: Iterable[tuple[int, str]]) -> str:
        """A weighted sum of rows in reverse Polish notation."""
        weights = [(row, Fraction(text)) for row, text in multipliers if Fraction(text)]
        scale = lcm(*(weight.denominator for _, weight in weights))
        words: list[str] = []
        for row, weight in weights:
            plus, factor = ["+"] if words else [], abs(int(weight * scale))
            words += [self._number(row, weight), *([str(factor), "*"] if factor > 1 else []), *plus]
        return " ".join(words)

    def _number(self, row: int, weight: Fraction) -> str:
        """The constraint that a row's multiplier of this sign goes with; the limit is the last one."""
        if row < 0:
            return str(self._first[-1] - (0 if self._optimal else 1))
        return str(self._first[row] + (self._rows[row][1] == "==" and weight > 0))


def _sum(terms: Terms) -> str:
    return "".join(f"{coefficient:+} x{x + 1} " for x, coefficient in terms)
