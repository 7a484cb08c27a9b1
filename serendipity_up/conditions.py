"""Conditions of unified-planning as formulas of the grounder, in negation normal form, and its effects.

An object fluent is a predicate with one argument more, its value.  Where one stands among the
arguments of another (``clear(below(x))``), it is a variable for whose value the fluent holds.  One that
gets a value loses every other one.  Where the condition says which value it has, only that one is named;
else all are, which is no less true.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from unified_planning.model import Effect as UPEffect
from unified_planning.model import Fluent, FNode, Variable
from unified_planning.model import Parameter as UPParameter
from unified_planning.model.walkers.dnf import Nnf

from serendipity.model import InputError
from serendipity.pddl.parsing import lifted
from serendipity_up.kinds import refusal
from serendipity_up.vocabulary import Owner, Vocabulary

Bound = Mapping[Variable, str]
"""What quantified variables are called."""


class Term(NamedTuple):
    """A term, or the start of an atom: the variables that it needs, and what has to hold of them."""

    words: tuple[str, ...]
    hidden: tuple[lifted.Parameter, ...] = ()
    guards: tuple[lifted.Literal, ...] = ()


class Reader:
    """Reads the expressions of one action or goal, and whether there were quantifiers in them."""

    def __init__(self, vocabulary: Vocabulary, owner: Owner = None) -> None:
        self.vocabulary = vocabulary
        self.quantified = False
        self._owner = owner
        self._fresh = 0
        self._nnf = Nnf(vocabulary.problem.environment)

    def formula(self, node: FNode, bound: Bound | None = None) -> lifted.Formula:
        """A condition."""
        return self._normal(self._nnf.get_nnf_expression(node), bound or {})

    def denied(self, node: FNode, bound: Bound) -> lifted.Formula:
        """The negation of a condition, likewise."""
        return self.formula(node.environment.expression_manager.Not(node), bound)

    def _normal(self, node: FNode, bound: Bound) -> lifted.Formula:
        """A condition in which only atoms and quantifiers are negated."""
        if node.is_and() or node.is_or():
            parts = tuple(self._normal(part, bound) for part in node.args)
            return lifted.And(parts) if node.is_and() else lifted.Or(parts)
        positive = not node.is_not()
        atom = node if positive else node.arg(0)
        if atom.is_bool_constant():
            return lifted.And() if atom.bool_constant_value() == positive else lifted.Or()
        if atom.is_exists() or atom.is_forall():
            inner, parameters = self.bind(atom.variables(), bound)
            self.quantified = True
            body = self.formula(atom.arg(0), inner) if positive else self.denied(atom.arg(0), inner)
            return lifted.Quantified(atom.is_forall() == positive, parameters, body)
        if atom.is_equals():
            return self._equal(atom, bound, positive)
        if atom.is_fluent_exp() or atom.is_dot():
            return self._closed(self._fluent(atom, bound), positive)
        raise self.error(f"'{atom}' is not supported as a condition")

    def bind(
        self, variables: Sequence[Variable], bound: Bound
    ) -> tuple[dict[Variable, str], tuple[lifted.Parameter, ...]]:
        """Names for quantified variables, and these as parameters."""
        fresh = [self._variable(variable.type) for variable in variables]
        names = (parameter.name for parameter in fresh)
        return {**bound, **dict(zip(variables, names, strict=True))}, tuple(fresh)

    def parameter(self, parameter: UPParameter) -> lifted.Parameter:
        """A declared parameter of an action."""
        return lifted.Parameter(f"?{parameter.name}", self.vocabulary.type(parameter.type))

    def target(self, node: FNode, bound: Bound) -> tuple[Fluent, lifted.Key]:
        """A fluent that is assigned to, with its predicate and arguments (in which are no fluents)."""
        inner = node.arg(0) if node.is_dot() else node
        return inner.fluent(), self._fluent(node, bound).words

    def term(self, node: FNode, bound: Bound) -> Term:
        """An object, or what stands for one."""
        if node.is_object_exp():
            return Term((self.vocabulary.object(node.object()),))
        if node.is_parameter_exp() and node.type.is_user_type():
            return Term((f"?{node.parameter().name}",))
        if node.is_variable_exp():
            return Term((bound[node.variable()],))
        if (node.is_fluent_exp() or node.is_dot()) and node.type.is_user_type():
            words, hidden, guards = self._fluent(node, bound)
            value = self._variable(node.type)
            return Term((value.name,), (*hidden, value), (*guards, lifted.Literal((*words, value.name))))
        raise self.error(f"'{node}' is not supported as an object")

    def value_of(self, kind: Fluent) -> lifted.Parameter:
        """A variable for any value of an object fluent."""
        return self._variable(kind.type)

    def error(self, message: str) -> InputError:
        """An error about the problem."""
        return refusal(self.vocabulary.problem, message)

    def _fluent(self, node: FNode, bound: Bound) -> Term:
        """The predicate and the arguments of a fluent."""
        owner, inner = self._owner, node
        if node.is_dot():
            name, inner = node.agent(), node.arg(0)
            owner = next(agent for agent in self.vocabulary.agents if agent.name == name)
        elif owner is not None and inner.fluent() not in owner.fluents:
            owner = None
        if not (inner.type.is_bool_type() or inner.type.is_user_type()):
            raise self.error(f"'{node}' is a number: only the costs of actions may depend on numbers")
        terms = [self.term(argument, bound) for argument in inner.args]
        words = (word for term in terms for word in term.words)
        return Term(
            (self.vocabulary.predicate(owner, inner.fluent()), *words),
            tuple(hidden for term in terms for hidden in term.hidden),
            tuple(guard for term in terms for guard in term.guards),
        )

    def _equal(self, node: FNode, bound: Bound, positive: bool) -> lifted.Formula:
        left, right = node.args
        if not left.type.is_user_type():
            raise self.error(f"'{node}' is about numbers: not supported as a condition")
        if right.is_fluent_exp() or right.is_dot():
            left, right = right, left
        if not (left.is_fluent_exp() or left.is_dot()):
            words = (lifted.EQUALITY, *self.term(left, bound).words, *self.term(right, bound).words)
            return lifted.Literal(words, positive)
        fluent, value = self._fluent(left, bound), self.term(right, bound)
        return self._closed(
            Term((*fluent.words, *value.words), fluent.hidden + value.hidden, fluent.guards + value.guards),
            positive,
        )

    def _closed(self, atom: Term, positive: bool) -> lifted.Formula:
        literal = lifted.Literal(lifted.Key(atom.words), positive)
        if not atom.hidden:
            return literal
        self.quantified = True
        return lifted.Quantified(False, atom.hidden, lifted.And((*atom.guards, literal)))

    def _variable(self, kind: object) -> lifted.Parameter:
        self._fresh += 1
        return lifted.Parameter(f"?.{self._fresh}", self.vocabulary.type(kind))


def effects_of(reader: Reader, effect: UPEffect, precondition: lifted.Formula) -> Iterator[lifted.Effect]:
    """What one effect does."""
    if not effect.is_assignment():
        raise reader.error(f"effect '{effect}': numbers that change are not supported")
    bound, parameters = reader.bind(list(effect.forall), {})
    conditions = () if effect.condition.is_true() else (reader.formula(effect.condition, bound),)
    fluent, target = reader.target(effect.fluent, bound)
    if parameters:
        reader.quantified = True
    if fluent.type.is_bool_type():
        yield from _assigned(reader, effect.value, bound, target, parameters, conditions)
        return
    value = reader.term(effect.value, bound)
    known = _known_value(target, (precondition, *conditions))
    old = reader.value_of(fluent)
    gone = lifted.Literal((*target, known or old.name), positive=False)
    new = lifted.Literal((*target, *value.words))
    if known is None or value.hidden:
        reader.quantified = True
    yield _effect(gone, parameters if known else (*parameters, old), conditions)
    yield _effect(new, (*parameters, *value.hidden), (*conditions, *value.guards))


def _assigned(
    reader: Reader,
    value: FNode,
    bound: Bound,
    target: lifted.Key,
    parameters: tuple[lifted.Parameter, ...],
    conditions: tuple[lifted.Formula, ...],
) -> Iterator[lifted.Effect]:
    """A truth value that is assigned."""
    if value.is_bool_constant():
        yield _effect(lifted.Literal(target, value.bool_constant_value()), parameters, conditions)
        return
    for truth, case in ((True, reader.formula(value, bound)), (False, reader.denied(value, bound))):
        yield _effect(lifted.Literal(target, truth), parameters, (*conditions, case))


def _effect(
    literal: lifted.Literal, parameters: tuple[lifted.Parameter, ...], conditions: tuple[lifted.Formula, ...]
) -> lifted.Effect:
    condition = None
    if conditions:
        condition = conditions[0] if len(conditions) == 1 else lifted.And(conditions)
    return lifted.Effect(literal, parameters, condition)


def _known_value(target: lifted.Key, conditions: tuple[lifted.Formula, ...]) -> str | None:
    """The value that some conditions say a fluent has."""
    for part in conditions:
        if isinstance(part, lifted.And):
            found = _known_value(target, part.parts)
            if found is not None:
                return found
        elif isinstance(part, lifted.Literal) and part.positive and part.key[:-1] == target:
            return part.key[-1]
    return None
