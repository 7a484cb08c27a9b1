"""The right answer beside each optimal plan of the human, with as little asked as the plans differ in."""

from collections import Counter
from collections.abc import Hashable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from serendipity.model import HumanPlan, LimitReachedError, Options, Task
from verify.base.optimal_plans import OptimalPlans
from verify.base.plan_graph import plan_graph
from verify.base.subproblem import in_plan
from verify.calls.answer import answer
from verify.calls.call import ExaminedCall
from verify.calls.methods import ANY_PLAN, BESIDE_PLANS, decide
from verify.certificate.humans import human_cost
from verify.exhaustive.beside_plans import HelpBesidePlans
from verify.exhaustive.epoch_by_epoch import OtherMethodError
from verify.limits import limits, uses
from verify.programs.effort import Attempt, Effort
from verify.programs.recorded import BESIDE_ANY
from verify.proofs.book import ProofReader


@dataclass(frozen=True, slots=True)
class SolvedPlan:
    """The figures of an answer beside one optimal ``pi_H``; None where there is no plan."""

    cost: Fraction | None
    objective: Fraction | None
    saving: Fraction | None
    opportunity: bool


class EachPlan:
    """Answers beside the human's optimal plans.

    Plans between which the call does not tell are one question (:func:`kin`).  Windows are searched beside
    all plans at once, where the rules and the method allow that; else question after question is asked.

    Attributes:
        graph: these plans.
        asked: beside how many of them an answer will be asked for.

    Raises:
        UsageError: there are more than ``max_ties``.
    """

    def __init__(self, task: Task, options: Options, effort: Effort, plans: OptimalPlans) -> None:
        self._task, self._options, self._effort, self._plans = task, options, effort, plans
        self.graph = plan_graph(task, plans, options)
        self.asked = self.graph.count
        self._known: dict[Hashable, SolvedPlan] = {}

    def beside(self, plan: HumanPlan) -> SolvedPlan:
        """The answer beside one plan."""
        shared = None if self._unaided else self._shared
        if self._unaided or shared is not None:
            return self._solved(None if shared is None else shared.beside(plan))
        call = self.call(plan)
        same = kin(call)
        if same not in self._known:
            self._known[same] = _solved(call)
        return self._known[same]

    def all(self) -> Counter[SolvedPlan]:
        """The answers, each with the number of plans that it is for."""
        if self._unaided:
            return Counter({self._solved(None): self.graph.count})
        shared = self._shared
        if shared is None:
            return Counter(self.beside(plan) for plan in self.graph.plans())
        found: Counter[SolvedPlan] = Counter()
        for score, count in shared.scores.items():
            found[self._solved(score)] += count
        return found

    @property
    def alone(self) -> Fraction | None:
        """What no answer is dearer than: leaving the human alone; None where robots have goals."""
        call = self._first
        return None if call.robots_goal or call.baseline is None else call.prices.cost(call.baseline)

    def none_cheaper(self, cost: Fraction) -> bool:
        """Whether one program says that nothing costs less, whichever of the plans the human is on."""
        if not self._one_program or self._shared is not None:
            return False
        nothing = self._nothing
        least = self._first.prices.units(cost)
        return self._unaided if least >= nothing[1] else self._nobody(nothing[0], least - 1)

    @cached_property
    def _first(self) -> ExaminedCall:
        return self.call(next(self.graph.plans()))

    @property
    def _nothing(self) -> tuple[int, int]:
        """Objective and cost of leaving the human alone."""
        nothing = self._first.do_nothing
        assert nothing is not None, "robots have no goals"
        return nothing

    @cached_property
    def _windows(self) -> bool:
        """Whether the plans are prefixes of windows that are replanned: all can be looked at together."""
        call = self._first
        options = call.options
        if self.asked < limits().several_plans or self.graph.waits or options.human_model != "omniscient":
            return False
        return self._effort.encoding == "automata" and options.windowed and ANY_PLAN.applies(call.question)

    @property
    def _one_program(self) -> bool:
        """Whether one program for all plans may be asked."""
        return self._windows and self._effort.method != "exhaustive" and uses(ANY_PLAN.name)

    @cached_property
    def _unaided(self) -> bool:
        """Whether one program says that nothing helps, whichever of the plans the human is on."""
        if not self._one_program:
            return False
        objective, cost = self._nothing
        if not self._nobody(objective - 1):
            return False
        return not self._first.may_tie(self._nothing) or self._nobody(objective, cost - 1)

    def _nobody(self, *limits: int) -> bool:
        """Whether a program allows no plan within limits on objective and cost, beside any optimal plan."""
        effort = self._effort
        left = effort.proof.left if isinstance(effort.proof, ProofReader) else None
        if left is not None and not (left and BESIDE_ANY in str(left[0].get("name"))):
            return False  # it took too long when the proof was written
        method = "pruned" if effort.method == "auto" else effort.method
        effort = replace(effort, deadline=ANY_PLAN.turn(effort.deadline), method=method)
        question = self._first.question.below(*limits).but(any_of=self.graph, deadline=effort.deadline)
        minimum = decide(question, effort, self._plans)
        if minimum.status == "undecided":
            self._effort.deadline.check()
        return minimum.status == "none"

    @cached_property
    def _shared(self) -> HelpBesidePlans | None:
        """The search beside all plans; None where it does not apply, or is not done in its turn."""
        effort, call = self._effort, self._first
        if not self._windows or effort.method == "program" or not uses(BESIDE_PLANS.name):
            return None
        if not BESIDE_PLANS.applies(call.question):
            return None
        deadline = BESIDE_PLANS.turn(effort.deadline) if effort.method == "auto" else effort.deadline
        question = call.question.but(deadline=deadline)
        try:
            found = HelpBesidePlans(question, self.graph, self._plans, bounded=effort.method == "auto")
        except OtherMethodError:
            return None
        except LimitReachedError:
            effort.deadline.check()
            if effort.method == "exhaustive":
                raise
            return None
        effort.attempts.append(Attempt(BESIDE_PLANS.name, decided=True, states=found.states))
        return found

    def call(self, plan: HumanPlan) -> ExaminedCall:
        """The call beside one plan."""
        return ExaminedCall(self._task, self._options, plan, self._plans, self._effort)

    def _solved(self, score: tuple[int, int] | None) -> SolvedPlan:
        """The answer where windows allow a score; None: nothing that undercuts leaving the human alone."""
        call = self._first
        assert call.baseline is not None
        idle = call.prices.cost(call.baseline)
        if score is None:
            return SolvedPlan(idle, idle, Fraction(0), opportunity=False)
        objective, cost = map(call.prices.cost, score)
        return SolvedPlan(cost, objective, idle - cost, opportunity=True)


def kin(call: ExaminedCall) -> Hashable:
    """What of ``pi_H`` a call depends on: optimal plans of which it is the same have the same answer.

    All optimal plans cost the same and have the same length.  Told humans are asked for what is not in their
    plan, whatever its order; a window of all epochs has no prefix that could follow it.
    """
    options, plan = call.options, call.human_plan
    if call.robots_goal or options.human_model != "omniscient" or plan is None:
        return plan
    if options.mode == "communication":
        if options.keep_prefix and (options.suffix, options.preservation) != ("replan", "kernel"):
            return plan
        return in_plan(call.task, plan) if options.keep_prefix or any(call.prices.talk) else None
    return None if call.question.is_free else plan


def _solved(call: ExaminedCall) -> SolvedPlan:
    if call.options.human_model == "omniscient":
        found = answer(call)
        return SolvedPlan(found.cost, found.objective, found.saving, found.opportunity)
    cost = human_cost(call)
    if cost is None or call.baseline is None:  # whatever can be done then is an opportunity
        return SolvedPlan(cost, cost, None, opportunity=cost is not None)
    saving = max(call.prices.cost(call.baseline) - cost, Fraction(0))
    return SolvedPlan(cost, cost, saving, opportunity=saving > 0)
