"""Goals that are disjunctions, as conjunctions: a task's goal knows nothing else.

A disjunction is compiled exactly, or refused.  There are two ways:

*Values of one variable*: one of some values means none of the others.
*A fact of its own*, which says whether the disjunction holds: what makes one of its literals
true adds the fact, and what makes the last true one false deletes it.  The latter depends on the
other literals, so such an action becomes several, as with conditional effects: one for each
literal that may hold, and one for none.  That is exact unless two agents change literals in one
epoch, one of them to false.  So either nothing makes a literal false, or one agent takes part in
all that changes any of them.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice

from serendipity.model import Condition, GroundAction, Task
from serendipity.model.task.actions import Disjunction
from serendipity.model.task.script import moments
from serendipity.model.task.variables import Variable, find_variables
from serendipity.pddl.grounding.normal import MAX_CASES
from serendipity.pddl.grounding.numbering import in_order
from serendipity.pddl.parsing.tree import quoted
from serendipity.pddl.work import Work

Literal = tuple[int, bool]
"""A fact's id, and whether it has to be true."""

Literals = tuple[Literal, ...]
"""Literals of different facts, two or more, of which one has to hold."""


class NotExactError(Exception):
    """A disjunction is not expressible; its text says why, for people."""


def with_disjunctions(
    task: Task, disjunctions: Iterable[Literals], work: Work, *, robots: bool = False
) -> Task:
    """The task whose human's goal, or else robots', asks for disjunctions, too; or a NotExactError."""
    compiled = _Compiled(task, work)
    literals = [literal for disjunction in disjunctions for literal in compiled.literals(disjunction)]
    facts = (*task.facts, *compiled.names)
    init = task.init.union(d.fact for d in compiled.extra if d.holds(task.init))
    actions = tuple(in_order(compiled.actions))
    return replace(
        task,
        facts=facts,
        init=init,
        goal=task.goal if robots else _more(task.goal, literals),
        robot_goal=_more(task.robot_goal, literals) if robots else task.robot_goal,
        actions=actions,
        disjunctions=(*task.disjunctions, *compiled.extra),
        known_variables=variables_behind(facts, init, moments(actions, task.script), work),
    )


def variables_behind(
    facts: Sequence[str], init: frozenset[int], actions: Sequence[GroundAction], work: Work
) -> tuple[Variable, ...]:
    """The finite-domain variables of a task: part of reading it, so that no planning call pays for it."""
    work.stage(f"finding variables of {len(facts):,} facts")
    return find_variables(facts, init, actions, work.deadline)


def _more(condition: Condition, literals: Sequence[Literal]) -> Condition:
    return Condition(
        tuple(sorted({*condition.positive, *(fact for fact, positive in literals if positive)})),
        tuple(sorted({*condition.negative, *(fact for fact, positive in literals if not positive)})),
    )


class _Compiled:
    """A task to which facts are added that say whether disjunctions hold."""

    def __init__(self, task: Task, work: Work) -> None:
        self.task = task
        self.work = work
        self.names: list[str] = []
        self.extra: list[Disjunction] = []
        self.actions = list(task.actions)
        self._beside = {f: frozenset(v.facts) for v in task.variables if not v.boolean for f in v.facts}

    def literals(self, disjunction: Literals) -> list[Literal]:
        """Literals that all hold iff one of the disjunction does."""
        values = self._others_false(disjunction)
        return [(self._fact(disjunction), True)] if values is None else values

    def _others_false(self, disjunction: Literals) -> list[Literal] | None:
        """For literals of one variable: none of its other values; None where they are of several."""
        group = self._beside.get(disjunction[0][0], frozenset())
        if not group.issuperset([fact for fact, _ in disjunction]):
            return None
        allowed = {f for f, positive in disjunction if positive}
        for fact, positive in disjunction:
            if not positive:
                allowed |= group - {fact}
        if len(allowed) == 1:
            return [(allowed.pop(), True)]
        return [(fact, False) for fact in sorted(group - allowed)]

    def _fact(self, disjunction: Literals) -> int:
        """A new fact that says whether the disjunction holds."""
        self._refuse_time(disjunction)
        fact = len(self.task.facts) + len(self.extra)
        name = f"either {' or '.join(map(self._text, disjunction))} holds"
        polled = self.work.deadline.each
        making = [i for i, action in enumerate(polled(self.actions)) if _makes(action, disjunction, True)]
        changing = [i for i, action in enumerate(polled(self.actions)) if _makes(action, disjunction, False)]
        undoing = sorted({*changing}.difference(making))
        if undoing and not self._somebody_in_all({*making, *undoing}):
            raise NotExactError(f"{quoted(name)} is not supported: several agents may change that at once")
        new = {i: [_also(self.actions[i], add=fact)] for i in making}
        for i in polled(undoing):
            new[i] = list(islice(self._cases(self.actions[i], disjunction, fact), MAX_CASES + 1))
            if len(new[i]) > MAX_CASES:
                raise NotExactError(f"more than {MAX_CASES} cases of the goal are not supported")
        self.actions = [case for i, a in enumerate(polled(self.actions)) for case in new.get(i, [a])]
        self.names.append(name)
        self.extra.append(Disjunction(fact, disjunction))
        return fact

    def _refuse_time(self, disjunction: Literals) -> None:
        """Refuse what changes while something goes on, or by itself: actions of one epoch say it exactly."""
        changed = {one.fact for one in self.task.script.facts}
        for action in self.actions:
            if action.timing is not None:
                changed.update(*(moment.add + moment.delete for moment in action.moments))
        fact = next((fact for fact, _ in disjunction if fact in changed), None)
        if fact is not None:
            name = quoted(self.task.facts[fact])
            raise NotExactError(
                f"'or' with {name}, which durative actions or the script change, is not supported"
            )

    def _text(self, literal: Literal) -> str:
        fact, positive = literal
        return self.task.facts[fact] if positive else f"not {self.task.facts[fact]}"

    def _somebody_in_all(self, actions: Iterable[int]) -> bool:
        """Whether one agent takes part in all of some actions, so that no two of them share an epoch."""
        return bool(set.intersection(*(set(self.actions[i].participants) for i in actions)))

    def _cases(self, action: GroundAction, disjunction: Literals, fact: int) -> Iterator[GroundAction]:
        """An action that makes literals false: as it is while another one holds, else undoing the fact."""
        case = action
        for other, positive in disjunction:
            if other in action.add or other in action.delete:
                continue
            known = self._truth(case, other)
            if known == positive:
                yield case
                return
            if known is None:
                yield _assume(case, other, positive)
                case = _assume(case, other, not positive)
        yield _also(case, delete=fact)

    def _truth(self, action: GroundAction, fact: int) -> bool | None:
        """Whether a fact is true where an action is applicable; None where that differs."""
        if fact in action.pre or fact in action.neg:
            return fact in action.pre
        return None if self._beside.get(fact, frozenset()).isdisjoint(action.pre) else False


def _makes(action: GroundAction, disjunction: Literals, truth: bool) -> bool:
    """Whether an action makes a literal of a disjunction true, or false."""
    return any(fact in (action.add if positive == truth else action.delete) for fact, positive in disjunction)


def _also(action: GroundAction, *, add: int | None = None, delete: int | None = None) -> GroundAction:
    """The action with one more effect, on a fact whose id is the largest."""
    more, less = action.add, action.delete
    return replace(
        action,
        add=more if add is None else (*more, add),
        delete=less if delete is None else (*less, delete),
    )


def _assume(action: GroundAction, fact: int, truth: bool) -> GroundAction:
    """The action with one more precondition."""
    if truth:
        return replace(action, pre=tuple(sorted((*action.pre, fact))))
    return replace(action, neg=tuple(sorted((*action.neg, fact))))
