"""Ground actions with disjunctive conditions or conditional effects, case by case."""

from collections import defaultdict
from collections.abc import Iterable, Iterator

from serendipity.model import InputError
from serendipity.pddl.grounding.blocks import Grounded
from serendipity.pddl.grounding.join import Relations
from serendipity.pddl.grounding.normal import MAX_CASES, Clause, Disjuncts, Lifted, TooManyCasesError
from serendipity.pddl.grounding.quantifiers import ground_key, substitute
from serendipity.pddl.parsing.lifted import Key, Literal, Unit
from serendipity.pddl.parsing.tree import quoted
from serendipity.pddl.work import Work

Values = dict[str, str]
"""Of a lifted action's variables."""


class Cases:
    """Ground actions with disjunctive conditions or conditional effects.

    One record for each disjunct of the condition, and for each combination of truths
    of the effects' conditions.
    """

    def __init__(
        self,
        lifted: Lifted,
        unit: Unit,
        relations: Relations,
        facts: defaultdict[Key, int],
        work: Work,
    ) -> None:
        self.lifted = lifted
        self.unit = unit
        self.facts = facts
        self.disjuncts = Disjuncts(unit, relations.decide, work)

    def expanded(self, records: Iterable[Grounded], bindings: Iterable[Values]) -> Iterator[Grounded]:
        """The cases of records and the values of their variables."""
        for record, values in zip(records, bindings, strict=True):
            try:
                yield from self._cases(record, values)
            except TooManyCasesError:
                raise self._error(record, "conditions") from None

    def _cases(self, record: Grounded, values: Values) -> list[Grounded]:
        choices = self.disjuncts.of_all(substitute(choice, values) for choice in self.lifted.choices)
        cases = [case for choice in choices if (case := self._with(record, choice)) is not None]
        effects: dict[Clause, list[Literal]] = {}
        for condition, literal in self.lifted.conditional:
            ground = Literal(ground_key(literal.key, values), literal.positive)
            for clause in self.disjuncts.of(substitute(condition, values)):
                effects.setdefault(clause, []).append(ground)
        for clause, literals in effects.items():
            cases = [new for case in cases for new in self._split(case, clause, literals)]
            if len(cases) > MAX_CASES:
                raise self._error(record, "conditional effects")
        return cases

    def _with(self, record: Grounded, clause: Clause) -> Grounded | None:
        case: Grounded | None = record
        for literal in sorted(clause):
            case = None if case is None else _assume(case, self.facts[literal.key], literal.positive)
        return case

    def _split(self, case: Grounded, clause: Clause, then: Iterable[Literal]) -> Iterator[Grounded]:
        """The condition false at its first literal, at its second, ..., or true."""
        for literal in sorted(clause):
            fact = self.facts[literal.key]
            otherwise = _assume(case, fact, not literal.positive)
            if otherwise is not None:
                yield otherwise
            known = _assume(case, fact, literal.positive)
            if known is None:
                return
            case = known
        add = tuple([self.facts[literal.key] for literal in then if literal.positive])
        delete = tuple([self.facts[literal.key] for literal in then if not literal.positive])
        pre, neg, gained, lost, *later = case.ids
        yield case._replace(ids=(pre, neg, gained + add, lost + delete, *later))

    def _error(self, record: Grounded, what: str) -> InputError:
        name = quoted(" ".join(record.key))
        message = f"action {name}: more than {MAX_CASES} cases of its {what} are not supported"
        return self.unit.domain_error(message, self.lifted.schema.line)


def _assume(record: Grounded, fact: int, truth: bool) -> Grounded | None:
    """The record with one more precondition, or None where it contradicts the others."""
    pre, neg, *others = record.ids
    if fact in (neg if truth else pre):
        return None
    if fact in (pre if truth else neg):
        return record
    more = ((*pre, fact), neg) if truth else (pre, (*neg, fact))
    return record._replace(ids=(*more, *others))
