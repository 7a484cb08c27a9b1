"""OPB: an objective to be minimised and constraints over variables that are 0 or 1."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple


class Constraint(NamedTuple):
    """``sum a x >= right``, with coefficients by variable."""

    terms: Mapping[str, int]
    right: int

    def holds(self, values: Mapping[str, int]) -> bool:
        """Whether an assignment satisfies it."""
        return sum(a * values[x] for x, a in self.terms.items()) >= self.right

    @property
    def negation(self) -> "Constraint":
        """What holds where this one does not."""
        return Constraint({x: -a for x, a in self.terms.items()}, 1 - self.right)


@dataclass(slots=True)
class PseudoBooleanProblem:
    """A problem; an equality is two constraints, first ``>=``, as VeriPB counts them.

    Attributes:
        objective: coefficients by variable; None where there is none.
    """

    constraints: list[Constraint] = field(default_factory=list)
    objective: dict[str, int] | None = None

    def add(self, terms: Mapping[str, int], sense: str, right: int) -> None:
        """One more row, ``<=``, ``>=`` or ``=``."""
        if sense != "<=":
            self.constraints.append(Constraint(dict(terms), right))
        if sense != ">=":
            self.constraints.append(Constraint({x: -a for x, a in terms.items()}, -right))

    @property
    def variables(self) -> list[str]:
        """All of them, in the order in which they are met."""
        rows = [self.objective or {}, *(constraint.terms for constraint in self.constraints)]
        return list(dict.fromkeys(x for row in rows for x in row))

    def cost(self, values: Mapping[str, int]) -> int:
        """The objective of an assignment."""
        return sum(a * values[x] for x, a in (self.objective or {}).items())


def terms_of(words: Iterable[str]) -> tuple[dict[str, int], int]:
    """Coefficients by variable, and what negated literals leave over: ``3 ~x1`` is ``-3 x1`` and 3."""
    listed, terms, constant = list(words), dict[str, int](), 0
    for number, literal in zip(listed[::2], listed[1::2], strict=True):
        name = literal.removeprefix("~")
        negated = name != literal
        terms[name] = terms.get(name, 0) + (-int(number) if negated else int(number))
        constant += int(number) if negated else 0
    return terms, constant


def constraint_of(text: str) -> tuple[dict[str, int], str, int]:
    """Terms, sense and right side of ``+1 x1 -2 ~x2 >= 1``."""
    sense = ">=" if ">=" in text else "="
    left, right = text.split(sense)
    terms, constant = terms_of(left.split())
    return terms, sense, int(right) - constant


def read(text: str) -> PseudoBooleanProblem:
    """The problem that an OPB file states, or a ValueError."""
    problem = PseudoBooleanProblem()
    for line in text.splitlines():
        if line.startswith("*") or not line.strip():
            continue
        statement = line.strip().removesuffix(";")
        if statement == line.strip():
            raise ValueError(f"expected ';' at the end of {line!r:.60}")
        if statement.startswith("min:"):
            problem.objective = terms_of(statement.removeprefix("min:").split())[0]
        else:
            problem.add(*constraint_of(statement))
    return problem
