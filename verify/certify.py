"""Certificates: every claim of a result, proved, refuted, undecided or out of scope."""

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from time import perf_counter

from serendipity.model import (
    Certificate,
    Claim,
    Deadline,
    HumanPlan,
    InputError,
    PlanError,
    Result,
    Step,
    Task,
    UsageError,
)
from verify.alone import OptimalPlans
from verify.answer import TIED_MODES, answer, calls
from verify.call import Call
from verify.claims import Examiner
from verify.goals import check_goals
from verify.humans import HumanExaminer, human_cost
from verify.minimise import Effort
from verify.policy import check_policy
from verify.rules import Checker, RuleReport
from verify.rules.alone import Alone
from verify.rules.replay import replay, replay_human
from verify.simulator import realised_claim
from verify.solver import solver_version
from verify.undecided import UNDECIDED, why

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
    human_plan: Iterable[str] | None = None,
) -> Certificate:
    """Examine every claim of a result.

    ``optimal`` stands for: no plan that the mode and its options allow has a lower objective,
    or the same objective at a lower cost.  The ties beyond (SPEC 3.1) are not examined.

    Args:
        task: the task that was asked.
        result: the answer.
        encoding: ``automata`` or ``paper``.
        solver: ``highs`` or ``cbc``.
        time_limit: seconds for the whole certificate, or None.
        human_plan: the plan that was given to the planner, where it is known; else the
            result's own ``pi_H`` counts as given if it is not the canonical one.

    Raises:
        InputError: the result is for another task.
        UsageError: there is no such encoding or solver.
    """
    started = perf_counter()
    _require_same_task(task, result)
    if result.mode == "assistance":
        claims = check_policy(task, result, Deadline(time_limit))
        return Certificate(claims, perf_counter() - started)
    deadline = Deadline(time_limit)
    effort = Effort(encoding=encoding, solver=solver, deadline=deadline)
    version = solver_version(solver)
    if "goals" in result.statistics:

        def one_goal(about: Task, answer: Result) -> tuple[Claim, ...]:
            return tuple(_Certifier(about, answer, effort).claims(None))

        claims = tuple(check_goals(task, result, one_goal, effort))
    else:
        claims = tuple(_Certifier(task, result, effort).claims(human_plan))
    return Certificate(claims, perf_counter() - started, version, encoding, effort.size)


def _require_same_task(task: Task, result: Result) -> None:
    human = task.agents[task.human]
    if result.human != human:
        raise InputError(f"result: is for another task: its human is '{result.human}', not '{human}'")
    stranger = next((name for name in result.human_plan or () if name not in task.named), None)
    if stranger is not None:
        raise InputError(
            f"result: is for another task: this one has no action '{stranger}' of its human plan"
        )


class _Certifier:
    def __init__(self, task: Task, result: Result, effort: Effort) -> None:
        self.task = task
        self.result = result
        self.effort = effort
        self.alone = Alone(task)
        self.plans = OptimalPlans(task, self.alone)
        self.checker = Checker(task, self.alone)

    def claims(self, given: Iterable[str] | None) -> Iterator[Claim]:
        """All claims, in order; what rules refute is not handed to a solver."""
        result = self.result
        report = self.checker.check(result)
        yield from self._rule_claims(report, given)
        yield from self._realised(report)
        wanted = self._wanted()
        if report.ok:
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

    def _wanted(self) -> list[str]:
        """The claims of the result that need an optimiser; the bound comes last."""
        result = self.result
        if result.status == "infeasible":
            return ["infeasible"]
        if result.status == "unknown" or result.cost is None:
            return []
        wanted = []
        if result.status == "optimal":
            if result.opportunity or not result.options.windowed:
                wanted.append("optimal")
            if not result.opportunity and result.human_plan is not None:
                wanted.append("no_opportunity")
        return wanted if result.lower_bound is None else [*wanted, "lower_bound"]

    def _rule_claims(self, report: RuleReport, given: Iterable[str] | None) -> Iterator[Claim]:
        for name in ("replay", "cost", "window"):
            violation = report.of(name)
            if violation is not None:
                yield Claim(name, "refuted", str(violation), seconds=report.seconds)
            elif name == "replay" and given is not None and tuple(given) != self.result.human_plan:
                yield Claim(name, "refuted", "pi_H is not the plan that was given", seconds=report.seconds)
            elif name in report.unchecked:
                yield Claim(name, "not_in_scope", report.unchecked[name])
            elif self.result.plan is not None:
                reason = _REPLAYED[name] + (self._about_pi_h() if name == "replay" else "")
                yield Claim(name, "proved", reason, seconds=report.seconds)
        if self.result.status == "unknown":
            yield Claim("replay", "not_in_scope", "there is no answer to examine")
        violation = report.of("lower_bound")
        if violation is not None:
            yield Claim("lower_bound", "refuted", str(violation), seconds=report.seconds)

    def _about_pi_h(self) -> str:
        """Whether ``pi_H`` is what SPEC 1 predicts; anything else must have been given."""
        names = self.result.human_plan
        try:
            canonical = self.plans.canonical()
        except UNDECIDED:
            return ""
        if names is None or canonical is None:
            return ""
        if names == tuple(self.task.actions[i].name for i in canonical):
            return "; pi_H is the human's canonical optimal plan"
        if self.task.cost_of(replay_human(self.task, names)) == self.task.cost_of(canonical):
            return "; pi_H is an optimal plan of the human, not the canonical one: taken as given"
        return "; pi_H is not optimal: taken as given"

    # -- claims that need an optimiser

    def _solved_claims(self, wanted: list[str]) -> Iterator[Claim]:
        try:
            examiner = self._examiner()
        except (UsageError, PlanError) as error:
            yield Claim("replay", "refuted", str(error))
            return
        if self._tied():
            yield self._ties(wanted)
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
        plan: HumanPlan | None = None if names is None else replay_human(self.task, names)
        call = Call(self.task, result.options, plan, self.plans, self.effort)
        if plan is not None or not call.needs_pi_h:
            assert call.horizon is not None
        sets = replay(self.task, result.plan or (), strict=result.options.strict).sets
        steps = tuple(Step(epoch, i) for epoch, chosen in sets.items() for i in chosen)
        kind = Examiner if result.options.human_model == "omniscient" else HumanExaminer
        return kind(call, result, steps, self.checker)

    def _individual(self, wanted: list[str]) -> Iterator[Claim]:
        """Mode ``individual``: his least cost alone, by exhaustive search."""
        started = perf_counter()
        try:
            worth = self.plans.worth(self.task.init)
        except UNDECIDED as error:
            worth, verdict, reason = None, "undecided", why(error)
        else:
            least = None if worth is None else float(worth[0])
            right = least == self.result.cost and (
                self.result.lower_bound is None or least is None or self.result.lower_bound <= least
            )
            verdict = "proved" if right else "refuted"
            reason = (
                "he can't reach his goal alone" if least is None else f"his least cost alone is {least:.12g}"
            )
        for name in wanted:
            if name != "no_opportunity":
                yield Claim(name, verdict, reason, seconds=perf_counter() - started)

    # -- ties over pi_H

    def _tied(self) -> bool:
        """Whether the result answers for all optimal ``pi_H`` at once."""
        options = self.result.options
        return options.ties != "fixed" and options.mode in TIED_MODES and "ties" in self.result.statistics

    def _ties(self, wanted: list[str]) -> Claim:
        """Each optimal ``pi_H`` is solved; the answers have to give the result's cost."""
        started = perf_counter()
        name = "optimal" if "optimal" in wanted or "no_opportunity" in wanted else (wanted or ["optimal"])[0]
        verdict, reason = "undecided", ""
        try:
            tied = calls(self.task, self.result.options, None, self.effort, self.plans)
            replans = self.result.options.human_model != "omniscient"
            costs = [human_cost(call) if replans else answer(call).cost for call in tied]
        except UNDECIDED as error:
            reason = why(error)
        except UsageError as error:
            verdict, reason = "refuted", str(error)
        else:
            verdict, reason = _compare(tied, costs, self.result)
        return Claim(name, verdict, reason, seconds=perf_counter() - started)


def _compare(tied: Sequence[Call], costs: Sequence[Fraction | None], result: Result) -> tuple[str, str]:
    known = [cost for cost in costs if cost is not None]
    if len(known) < len(costs):
        right = result.cost is None
        return ("proved" if right else "refuted"), "with some optimal pi_H there is no plan"
    ties = result.options.ties
    if ties == "expected":
        expected = sum(known, Fraction(0)) / len(known)
    else:
        expected = min(known) if ties == "optimistic" else max(known)
    words = f"the {ties} cost over {len(known)} optimal plans of the human is {float(expected):.12g}"
    if result.cost != float(expected):
        return "refuted", words
    by_plan = {
        tuple(call.task.actions[i].name for i in call.human_plan or ()): float(cost)
        for call, cost in zip(tied, known, strict=True)
    }
    listed = result.statistics["ties"]
    said = (
        [(tuple(entry["human_plan"]), entry["cost"]) for entry in listed] if isinstance(listed, list) else []
    )
    if not said or any(by_plan.get(plan) != cost for plan, cost in said):
        return "refuted", f"{words}, but the answers listed are others"
    return "proved", words
