"""Goals: literals that have to hold, and disjunctions of literals."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from itertools import chain

from serendipity.model import InputError
from serendipity.pddl.grounding.join import Relations
from serendipity.pddl.grounding.normal import MAX_CASES, Disjuncts, TooManyCasesError, require_literals
from serendipity.pddl.grounding.quantifiers import assignments, instances, negated, simplified, substitute
from serendipity.pddl.parsing.lifted import EQUALITY, And, Formula, Literal, Or, Quantified, Unit
from serendipity.pddl.work import Work

Disjunction = tuple[Literal, ...]
"""Literals of which one has to hold; ascending, two or more."""


@dataclass(slots=True)
class Goal:
    """A goal in conjunctive normal form: literals, and disjunctions of others, in one order in every run."""

    unit: Unit
    literals: dict[Literal, None] = field(default_factory=dict)
    disjunctions: dict[Disjunction, None] = field(default_factory=dict)

    def error(self, message: str) -> InputError:
        """An error in the goal."""
        return self.unit.problem_error(message, self.unit.problem.goal_line)

    def __bool__(self) -> bool:
        return bool(self.literals or self.disjunctions)

    def named(self) -> list[Literal]:
        """Every literal of it."""
        return [*dict.fromkeys(chain(self.literals, *self.disjunctions))]

    def leave_out(self, other: "Goal") -> None:
        """Leave out what another goal asks for as well."""
        self.literals = {one: None for one in self.literals if one not in other.literals}
        self.disjunctions = {one: None for one in self.disjunctions if one not in other.disjunctions}

    def simplify(self, truth: Callable[[Literal], bool | None]) -> None:
        """Drop from disjunctions what is known, by ``truth`` in all states or by what has to hold."""
        known = -1
        while known < len(self.literals):
            known = len(self.literals)
            pending, self.disjunctions = self.disjunctions, {}
            for disjunction in pending:
                self._add(disjunction, truth)

    def _add(self, disjunction: Disjunction, truth: Callable[[Literal], bool | None]) -> None:
        known = [self._known(literal, truth) for literal in disjunction]
        if True in known:
            return
        rest = tuple(lit for lit, value in zip(disjunction, known, strict=True) if value is None)
        if len(rest) > 1:
            self.disjunctions[rest] = None
        else:  # where nothing is left, a literal that never holds says that the goal can't be reached
            self.literals[min(rest or disjunction)] = None

    def _known(self, literal: Literal, truth: Callable[[Literal], bool | None]) -> bool | None:
        if literal in self.literals:
            return True
        return False if literal.opposite in self.literals else truth(literal)


def read_goal(unit: Unit, relations: Relations, work: Work) -> Goal:
    """The goal of some files.

    Static facts stay in it, so that an impossible goal is one that can't be reached;
    they decide only what would be a disjunction without them.

    Raises:
        InputError: it can never hold, or has too many cases.
    """
    reader = _Reader(Goal(unit), relations, work)
    formula = simplified(unit.problem.goal, unit)
    place = f"{unit.problem_file}:{unit.problem.goal_line}: goal"
    require_literals(instances(formula, unit), place, work)
    reader.collect(formula)
    literals = reader.goal.literals
    if any(not literal.positive and literal.opposite in literals for literal in work.deadline.each(literals)):
        raise reader.never()
    return reader.goal


class _Reader:
    def __init__(self, goal: Goal, relations: Relations, work: Work) -> None:
        self.goal = goal
        self.relations = relations
        self.work = work
        self.disjuncts = Disjuncts(goal.unit, relations.decide, work)

    def never(self) -> InputError:
        return self.goal.error("the goal can never hold")

    def collect(self, formula: Formula) -> None:
        self.work.deadline.tick()
        match formula:
            case Literal(key):
                if key[0] != EQUALITY:
                    self.goal.literals[formula] = None
                elif not self.relations.holds(formula, key):
                    raise self.never()
            case And(parts) | Or((_,) as parts):
                for part in parts:
                    self.collect(part)
            case Quantified(True, parameters, body):
                for values in assignments(parameters, self.goal.unit):
                    self.collect(substitute(body, values))
            case _:
                self._add(self._disjunctions(formula))

    def _disjunctions(self, formula: Formula) -> list[Disjunction]:
        """The conjunctive normal form of a condition: its negation's disjuncts, negated."""
        try:
            found = self.disjuncts.of(negated(formula))
        except TooManyCasesError:
            raise self.goal.error(f"more than {MAX_CASES} cases of the goal are not supported") from None
        return [tuple(sorted(literal.opposite for literal in clause)) for clause in found]

    def _add(self, disjunctions: Iterable[Disjunction]) -> None:
        for disjunction in disjunctions:
            if not disjunction:
                raise self.never()
            if len(disjunction) == 1:
                self.goal.literals[disjunction[0]] = None
            else:
                self.goal.disjunctions[disjunction] = None
