"""Certificates: every claim of a result, proved, refuted, undecided or out of scope."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from time import perf_counter

from serendipity.model import (
    Certificate,
    Claim,
    Deadline,
    HumanPlan,
    PlanError,
    Result,
    Step,
    Task,
    UsageError,
)
from serendipity.model.collection import no_collection
from verify.base.individual import IndividualOptimum
from verify.base.obligations import BY_RULES, complete, is_mean, is_tied, needed
from verify.base.optimal_plans import OptimalPlans
from verify.base.undecided import END_SHARE, UNDECIDED, why
from verify.calls.call import Call
from verify.certificate.claims import Examiner
from verify.certificate.humans import HumanExaminer
from verify.certificate.tied import examine
from verify.goals import check_goals
from verify.policy import check_policy
from verify.programs.minimise import Effort
from verify.rules import Checker, RuleReport
from verify.rules.header import require_same_task
from verify.rules.replay import replay, replay_human
from verify.simulator import realised_claim
from verify.solvers.mip import solver_version

_REPLAYED = {
    "replay": "every step follows the rules and the goals hold at the end",
    "cost": "every figure is the sum of what it consists of",
    "window": "prefix, window and suffix are as the mode demands",
}


def certify(
    task: Task,
    result: Result,
    *,
    encoding: str = "automata",
    solver: str = "highs",
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
    human_plan: Iterable[str] | None = None,
) -> Certificate:
    """Examine every claim of a result.

    ``optimal`` stands for: no plan that the mode and its options allow has a lower objective,
    or the same objective at a lower cost.  The ties beyond (semantics 3.1) are not examined.

    Args:
        task: the task that was asked.
        result: the answer.
        encoding: ``automata`` or ``paper``.
        solver: ``highs`` or ``cbc``.
        time_limit: seconds for the whole certificate, or None.
        memory_limit: what this process and a solver's may have in memory, in MiB, or None.
        deadline: one that other work shares, such as loading the task; it holds beside the limits.
        human_plan: the plan that was given to the planner, where it is known; else the
            result's own ``pi_H`` counts as given if it is not the canonical one.

    Returns:
        What a limit kept from being examined is ``undecided``; what was decided before stays so.

    Raises:
        InputError: the result is for another task.
        UsageError: there is no such encoding or solver.
    """
    limits = (deadline or Deadline()).within(time_limit, memory_limit).sooner(END_SHARE)
    with no_collection():  # beside a large task a collection takes longer than a short limit
        return _certify(task, result, encoding, solver, limits, human_plan)


def _certify(
    task: Task,
    result: Result,
    encoding: str,
    solver: str,
    deadline: Deadline,
    human_plan: Iterable[str] | None,
) -> Certificate:
    started = perf_counter()
    result = result.checked()
    require_same_task(task, result)
    if result.mode == "assistance":
        claims = complete(result, check_policy(task, result, deadline))
        return Certificate(claims, perf_counter() - started)
    effort = Effort(encoding=encoding, solver=solver, deadline=deadline)
    version = solver_version(solver)
    if "goals" in result.statistics:

        def one_goal(about: Task, answer: Result) -> tuple[Claim, ...]:
            return _Certifier(about, answer, effort).claims(None)

        claims = tuple(check_goals(task, result, one_goal, deadline, effort))
    else:
        claims = _Certifier(task, result, effort).claims(human_plan)
    return Certificate(complete(result, claims), perf_counter() - started, version, encoding, effort.size)


class _Certifier:
    def __init__(self, task: Task, result: Result, effort: Effort) -> None:
        self.task = task
        self.result = result
        self.effort = effort
        self.alone = IndividualOptimum(task, effort.deadline)
        self.plans = OptimalPlans(task, self.alone)
        self.checker = Checker(task, self.alone)

    def claims(self, given: Iterable[str] | None) -> tuple[Claim, ...]:
        """All claims, in order; what rules refute is not handed to a solver.

        What ``pi_H`` is comes last: it decides nothing, and working it out may take what time there is.
        """
        first, *others = tuple(self._claims(given)) or (None,)
        if first is None:
            return ()
        if (first.claim, first.verdict) == ("replay", "proved"):
            first = replace(first, reason=first.reason + self._about_pi_h())
        return first, *others

    def _claims(self, given: Iterable[str] | None) -> Iterator[Claim]:
        report = self.checker.check(self.result)
        yield from self._rule_claims(report, given)
        yield from self._realised(report)
        wanted = [name for name in needed(self.result) if name not in (*BY_RULES, "realised")]
        if report.stopped is not None:
            yield from (Claim(name, "undecided", report.stopped) for name in wanted)
        elif report.ok and wanted:
            yield from self._solved_claims(wanted)
        else:
            refuted = {violation.claim for violation in report.violations}
            out = "the result breaks a rule already"
            yield from (Claim(name, "not_in_scope", out) for name in wanted if name not in refuted)

    def _realised(self, report: RuleReport) -> Iterator[Claim]:
        """The verdicts on humans who replan: the plan is played again."""
        if report.of("replay") is not None:
            if self.result.realised:
                yield Claim("realised", "not_in_scope", "the plan can't be replayed")
            return
        claim = realised_claim(self.task, self.result, self.plans)
        if claim is not None:
            yield claim

    def _rule_claims(self, report: RuleReport, given: Iterable[str] | None) -> Iterator[Claim]:
        for name in ("replay", "cost", "window"):
            violation = report.of(name)
            if violation is not None:
                yield Claim(name, "refuted", str(violation), seconds=report.seconds)
            elif name == "replay" and given is not None and tuple(given) != self.result.human_plan:
                yield Claim(name, "refuted", "pi_H is not the plan that was given", seconds=report.seconds)
            elif name in report.unchecked:
                yield Claim(name, "not_in_scope", report.unchecked[name])
            elif name in report.undecided and (name == "replay" or self.result.plan is not None):
                yield Claim(name, "undecided", report.undecided[name], seconds=report.seconds)
            elif self.result.plan is not None:
                yield Claim(name, "proved", _REPLAYED[name], seconds=report.seconds)
        if self.result.status == "unknown" and "replay" not in report.undecided:
            yield Claim("replay", "not_in_scope", "there is no answer to examine")
        violation = report.of("lower_bound")
        if violation is not None:
            yield Claim("lower_bound", "refuted", str(violation), seconds=report.seconds)

    def _about_pi_h(self) -> str:
        """Whether ``pi_H`` is what semantics 1 predicts; anything else must have been given."""
        try:
            return self._kind_of_pi_h()
        except UNDECIDED:
            return ""

    def _kind_of_pi_h(self) -> str:
        names, canonical = self.result.human_plan, self.plans.canonical()
        if names is None or canonical is None:
            return ""
        if names == tuple(self.task.actions[i].name for i in canonical):
            return "; pi_H is the human's canonical optimal plan"
        plan = replay_human(self.task, names, self.effort.deadline)
        if self.task.cost_of(plan) == self.task.cost_of(canonical):
            return "; pi_H is an optimal plan of the human, not the canonical one: taken as given"
        return "; pi_H is not optimal: taken as given"

    # -- claims that need an optimiser

    def _solved_claims(self, wanted: list[str]) -> Iterator[Claim]:
        try:
            examiner = self._examiner()
        except (UsageError, PlanError) as error:
            yield Claim("replay", "refuted", str(error))
            return
        except UNDECIDED as error:
            yield from (Claim(name, "undecided", why(error)) for name in wanted)
            return
        if is_tied(self.result) and self.result.status in ("optimal", "feasible"):
            yield from self._ties(wanted)
            return
        if self.result.mode == "individual":
            yield from self._individual(wanted)
            return
        figures = examiner.claim("cost", lambda: examiner.savings() or ("proved", "", None))
        if figures.verdict != "proved":
            yield figures
        examined: dict[str, Claim] = {}
        for name in wanted:
            claim = self._examine(examiner, name, examined)
            examined[name] = claim
            yield claim

    def _examine(self, examiner: Examiner, name: str, examined: dict[str, Claim]) -> Claim:
        if name == "lower_bound" and self.result.status == "optimal":
            return self._same_as(examined)
        if name == "no_opportunity" and "optimal" in examined:
            proved = examined["optimal"]
            if proved.verdict != "proved":
                return Claim(name, proved.verdict, f"as 'optimal': {proved.reason}", proved.counterexample)
            return examiner.claim(name, examiner.optimum_is_no_opportunity)
        if name == "optimal" and self.result.opportunity:
            return examiner.claim(name, lambda: examiner.opportunity_is_cheaper() or examiner.optimal())
        return examiner.claim(name, getattr(examiner, name))

    def _same_as(self, examined: dict[str, Claim]) -> Claim:
        """An optimum's bound is its objective (a rule): what holds for one holds for the other."""
        claim = examined.get("optimal") or examined["no_opportunity"]
        return Claim(
            "lower_bound",
            claim.verdict,
            f"as '{claim.claim}': {claim.reason}",
            claim.counterexample,
            bound=claim.bound,
        )

    def _examiner(self) -> Examiner:
        result = self.result
        names = result.human_plan
        deadline = self.effort.deadline
        plan: HumanPlan | None = None if names is None else replay_human(self.task, names, deadline)
        call = Call(self.task, result.options, plan, self.plans, self.effort)
        if plan is not None or not call.needs_pi_h:
            assert call.horizon is not None
        sets = replay(self.task, result.plan or (), deadline, strict=result.options.strict).sets
        steps = tuple(Step(epoch, i) for epoch, chosen in sets.items() for i in chosen)
        kind = Examiner if result.options.human_model == "omniscient" else HumanExaminer
        return kind(call, result, steps, self.checker)

    def _individual(self, wanted: list[str]) -> Iterator[Claim]:
        """Mode ``individual``: his least cost alone, by exhaustive search."""
        started = perf_counter()
        try:
            verdict, reason = self._alone()
        except UNDECIDED as error:
            verdict, reason = "undecided", why(error)
        for name in wanted:
            yield Claim(name, verdict, reason, seconds=perf_counter() - started)

    def _alone(self) -> tuple[str, str]:
        result, worth = self.result, self.plans.worth(self.task.init)
        if worth is None:
            right = result.cost is None
            return "proved" if right else "refuted", "the goal can't be reached alone"
        least = float(worth[0])
        right = result.lower_bound is None or result.lower_bound <= least
        if result.status != "unknown":
            right = right and result.cost == least
            if result.human_plan is not None:
                given = self.task.cost_of(replay_human(self.task, result.human_plan, self.effort.deadline))
                right = right and result.saving_alone == float(given - worth[0])
        return "proved" if right else "refuted", f"the least cost alone is {least:.12g}"

    def _ties(self, wanted: list[str]) -> Iterator[Claim]:
        """Each optimal ``pi_H`` is solved; the answers have to give the result's figures."""
        started = perf_counter()
        try:
            verdict, reason = examine(self.task, self.result, self.effort, self.plans)
        except UNDECIDED as error:
            verdict, reason = "undecided", why(error)
        except UsageError as error:
            verdict, reason = "refuted", str(error)
        if is_mean(self.result):
            wanted = ["cost", *wanted]
        for name in wanted:
            yield Claim(name, verdict, reason, seconds=perf_counter() - started)
