"""A small checker of VeriPB's proofs, versions 1.1 and 2.0, as far as this program's make use of them.

Steps: ``f``, ``pol`` with ``+`` and ``*``, ``rup``, a solution (``o``, ``soli``), and how a proof ends.
Anything else is an error, so that nothing is accepted which is not understood.
"""

from collections import defaultdict
from itertools import chain

from serendipity_testing.pseudo_boolean.opb import Constraint, PseudoBooleanProblem, constraint_of

_SOLUTIONS = {"1.1": "o", "2.0": "soli"}


class ProofError(ValueError):
    """A proof does not hold; the text says which line."""


def check(problem: PseudoBooleanProblem, proof: str) -> int | None:
    """The optimum that a proof shows; None where it shows that nothing satisfies the constraints.

    Raises:
        ProofError: it shows neither.
    """
    checked = _Checked(problem)
    lines = [(n, line.split()) for n, line in enumerate(proof.splitlines(), 1) if line.strip()]
    try:
        for n, words in lines:
            if not checked.take(words):
                raise ProofError(f"line {n}: {' '.join(words):.60}")
    except (ValueError, LookupError) as error:
        raise error if isinstance(error, ProofError) else ProofError(f"line {n}: {error}") from None
    if not checked.ended:
        raise ProofError("expected a conclusion at the end")
    return checked.best


class _Checked:
    """What a proof has derived so far."""

    def __init__(self, problem: PseudoBooleanProblem) -> None:
        self.best: int | None = None
        self.ended = False
        self._problem = problem
        self._version = ""
        self._concluded = False
        self._known: list[Constraint] = []
        self._slack: list[int] = []
        self._places: defaultdict[str, list[tuple[int, int]]] = defaultdict(list)
        for constraint in problem.constraints:
            self._learn(constraint)

    def _learn(self, constraint: Constraint) -> bool:
        place = len(self._known)
        self._known.append(constraint)
        self._slack.append(_slack(constraint))
        for x, a in constraint.terms.items():
            self._places[x].append((place, a))
        return True

    def take(self, words: list[str]) -> bool:
        """Whether a line holds."""
        if not self._version:
            self._version = words[-1]
            return words[:-1] == ["pseudo-Boolean", "proof", "version"] and self._version in _SOLUTIONS
        rule, rest = words[0], words[1:]
        if self.ended or (self._concluded and rule != "end"):
            return False
        if rule == _SOLUTIONS[self._version]:
            return self._solution(rest)
        rules = {"f": self._formula, "pol": self._combined, "rup": self._propagated}
        ends = (
            {"c": self._ends}
            if self._version == "1.1"
            else {"output": lambda rest: rest == ["NONE"], "conclusion": self._conclusion, "end": self._end}
        )
        return rule in (rules | ends) and (rules | ends)[rule](rest)

    def _formula(self, words: list[str]) -> bool:
        return words == [str(len(self._problem.constraints))]

    def _numbered(self, word: str) -> Constraint:
        if not 0 < int(word) <= len(self._known):
            raise ValueError(f"there is no constraint {word}")
        return self._known[int(word) - 1]

    def _combined(self, words: list[str]) -> bool:
        """A weighted sum of constraints; a factor is not negative."""
        stack: list[Constraint] = []
        factor = 0
        for word, following in zip(words, [*words[1:], ""], strict=True):
            if word == "*":
                terms, right = stack.pop()
                stack.append(Constraint({x: factor * a for x, a in terms.items()}, factor * right))
            elif word == "+":
                stack.append(_sum(stack.pop(), stack.pop()))
            elif following == "*":
                factor = int(word)
                if factor < 1:
                    raise ValueError(f"expected a factor of at least 1, got {factor}")
            else:
                stack.append(self._numbered(word))
        (total,) = stack
        return self._learn(total)

    def _propagated(self, words: list[str]) -> bool:
        """A constraint whose negation unit propagation finds to be impossible."""
        terms, sense, right = constraint_of(" ".join(words).removesuffix(";"))
        found = Constraint(terms, right)
        return sense == ">=" and self._impossible(found.negation) and self._learn(found)

    def _impossible(self, extra: Constraint) -> bool:
        slack = [*self._slack, _slack(extra)]
        known = [*self._known, extra]
        values: dict[str, int] = {}
        waiting = list(range(len(known)))
        while waiting:
            place = waiting.pop()
            if slack[place] < 0:
                return True
            for x, a in known[place].terms.items():
                if x in values or abs(a) <= slack[place]:
                    continue
                values[x] = int(a > 0)
                own = [(len(self._known), extra.terms[x])] if x in extra.terms else []
                for other, b in chain(self._places.get(x, ()), own):
                    if (b > 0) != (a > 0):
                        slack[other] -= abs(b)
                        waiting.append(other)
        return False

    def _solution(self, words: list[str]) -> bool:
        """A solution is improved on from now on."""
        values = {word.removeprefix("~"): int(not word.startswith("~")) for word in words}
        if self._problem.objective is None or not all(each.holds(values) for each in self._known):
            return False
        self.best = self._problem.cost(values)
        better = {x: -a for x, a in self._problem.objective.items()}
        return self._learn(Constraint(better, 1 - self.best))

    def _ends(self, words: list[str]) -> bool:
        self.ended = len(words) == 1 and _slack(self._numbered(words[0])) < 0
        return self.ended

    def _conclusion(self, words: list[str]) -> bool:
        """``UNSAT : number``, or ``BOUNDS least : number most``."""
        best = str(self.best)
        said = ["UNSAT"] if self._problem.objective is None else ["BOUNDS", best]
        number = words[len(said) + 1] if len(words) > len(said) + 1 else "0"
        end = [] if self._problem.objective is None else [best]
        self._concluded = words == [*said, ":", number, *end] and _slack(self._numbered(number)) < 0
        return self._concluded

    def _end(self, words: list[str]) -> bool:
        self.ended = self._concluded and words == ["pseudo-Boolean", "proof"]
        return self.ended


def _slack(constraint: Constraint) -> int:
    """By how much the left side can exceed the right one; negative where it can't reach it."""
    return sum(a for a in constraint.terms.values() if a > 0) - constraint.right


def _sum(one: Constraint, other: Constraint) -> Constraint:
    terms = dict(one.terms)
    for x, a in other.terms.items():
        terms[x] = terms.get(x, 0) + a
    return Constraint(terms, one.right + other.right)
