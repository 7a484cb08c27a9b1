"""Certificates: every claim of a result, proved, refuted, undecided or out of scope."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from time import perf_counter

from serendipity.model import (
    Certificate,
    Claim,
    Deadline,
    HumanPlan,
    Options,
    PlanError,
    Result,
    Step,
    Task,
    UsageError,
)
from serendipity.model.numbers import agrees, excess
from serendipity.model.resources.collection import no_collection
from serendipity.model.task.gate import needs_time
from verify.base import wording
from verify.base.beside_script import alone_of
from verify.base.obligations import BY_RULES, complete, is_mean, is_tied, needed
from verify.base.optimal_plans import OptimalPlans
from verify.base.undecided import UNDECIDED, why
from verify.calls.answer import answer
from verify.calls.call import ExaminedCall
from verify.calls.methods import require_known
from verify.calls.results import to_result
from verify.calls.single_epochs import examined_in_time
from verify.certificate.claims import Examiner, Verdict
from verify.certificate.humans import HumanExaminer
from verify.certificate.provable import require_programs
from verify.certificate.simulator import realised_claim
from verify.certificate.tied import combined
from verify.limits import limited, limits
from verify.policy import check_policy
from verify.programs.alone import cost_alone
from verify.programs.effort import Effort, NoProgramError
from verify.proofs.book import ProofReader, ProofWriter
from verify.rules import Checker, RuleReport
from verify.rules.header import require_same_task
from verify.rules.nobody_pays import under_the_rule
from verify.rules.replay import replay, replay_human
from verify.scenarios.check import claims_over_scenarios
from verify.scenarios.proof import ScenariosProof
from verify.solvers.mip import solver_version


def certify(
    task: Task,
    result: Result,
    *,
    encoding: str = "automata",
    solver: str = "highs",
    method: str = "auto",
    methods: Sequence[str] = (),
    proof: ProofWriter | ProofReader | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> Certificate:
    """Examine every claim of a result.

    ``optimal`` stands for: no plan that the mode and its options allow has a lower objective,
    or the same objective at a lower cost.  The ties beyond (semantics 3.1) are not examined.

    Args:
        encoding: ``automata`` or ``paper``.
        solver: ``highs`` or ``cbc``.
        method: ``auto``; ``program``: the solver decides every program, also where reachability and
            shortest paths could; ``exhaustive``: no program, but a search of all states.
        methods: those of :mod:`verify.calls.methods` that take turns under ``auto``, by name; with a minus
            sign in front: all but these.
        proof: where the programs that convinced are written down, or read from instead of asking a
            solver; the method is ``program`` then.
        time_limit: seconds for the whole certificate, or None.
        memory_limit: what this process and a solver's may have in memory, in MiB, or None.
        deadline: one that other work shares, such as loading the task; it holds beside the limits.

    Returns:
        What a limit kept from being examined is ``undecided``; what was decided before stays so.

    Raises:
        InputError: the result is for another task.
        UsageError: there is no such encoding, solver or method, or no program that proves such a result.
    """
    require_known(tuple(methods))
    end = (deadline or Deadline()).within(time_limit, memory_limit).sooner(limits().end_share)
    if proof is not None:
        require_programs(result, method)
        method = "program"
    effort = Effort(encoding, solver, end, method, proof)
    given = {"methods": tuple(methods)} if methods else {}
    with limited(**given), no_collection():  # a collection takes longer than a short limit
        return _certify(task, result, effort)


def _certify(task: Task, result: Result, effort: Effort) -> Certificate:
    started = perf_counter()
    result = result.checked()
    require_same_task(task, result)
    if result.mode == "assistance":
        claims = complete(result, check_policy(task, result, effort.deadline))
        return Certificate(claims, perf_counter() - started)
    version = solver_version(effort.solver)
    timed = needs_time(task, options=result.options) or result.in_time
    if timed and effort.encoding != "automata":
        raise UsageError("encoding: the paper's equations know no time; expected automata")

    def examine(unit: Task, said: Result) -> tuple[Claim, ...]:
        return _examined(unit, said, effort, task)

    found = examined_in_time(task, result, effort.deadline, examine) if timed else examine(task, result)
    claims, calls = complete(result, found), len(effort.calls)
    return Certificate(claims, perf_counter() - started, version, effort.encoding, effort.size, calls)


def _examined(task: Task, result: Result, effort: Effort, original: Task) -> tuple[Claim, ...]:
    """Semantics 3, or 11: where one scenario is left, the answer is one of section 3."""

    def alone(own: Task, said: Result) -> tuple[Claim, ...]:
        def examine(bound: Task, plain: Result) -> tuple[Claim, ...]:
            return _Certifier(bound, plain, effort, own, said.options).claims()

        def solve_it(bound: Task, options: Options, names: Sequence[str] | None) -> Result | None:
            plans = OptimalPlans(bound, alone_of(bound, effort.deadline, options))
            try:
                plan = None if names is None else replay_human(bound, names, effort.deadline)
                return to_result(answer(ExaminedCall(bound, options.but(ties="fixed"), plan, plans, effort)))
            except UNDECIDED:
                return None

        return under_the_rule(own, said, original, effort.deadline, examine, solve_it)

    if not result.says("goals"):
        return alone(task, result)
    return claims_over_scenarios(
        task,
        result,
        original,
        effort.deadline,
        alone,
        lambda lines: ScenariosProof(result, lines, effort).claims(),
    )


class _Certifier:
    """The claims of one result; ``without_rule`` is the task as humans who replan know it, with options."""

    def __init__(
        self, task: Task, result: Result, effort: Effort, without_rule: Task, options: Options
    ) -> None:
        self.task = task
        self._without_rule, self._options = without_rule, options
        self.result = result
        self.effort = effort
        self.alone = alone_of(task, effort.deadline, result.options)
        self.plans = OptimalPlans(task, self.alone)
        self.checker = Checker(task, self.alone)

    def claims(self) -> tuple[Claim, ...]:
        """All claims, in order; what rules refute is not handed to a solver.

        What ``pi_H`` is comes last: it decides nothing, and working it out may take what time there is.
        """
        first, *others = tuple(self._claims()) or (None,)
        if first is None:
            return ()
        if (first.claim, first.verdict) == ("replay", "proved"):
            first = replace(first, reason=first.reason + self._about_pi_h())
        return first, *others

    def _claims(self) -> Iterator[Claim]:
        with suppress(PlanError, *UNDECIDED):  # the rules say what is wrong with it
            self._tell_pi_h(self.alone.suppose)
        report = self.checker.check(self.result)
        yield from self._rule_claims(report)
        wanted = [name for name in needed(self.result) if name not in (*BY_RULES, "realised")]
        if report.stopped is not None:
            yield from (Claim(name, "undecided", report.stopped) for name in wanted)
        elif report.ok and wanted:
            yield from self._solved_claims(wanted)
        else:
            refuted = {violation.claim for violation in report.violations}
            out = (name for name in wanted if name not in refuted)
            yield from (Claim(name, "not_in_scope", wording.RESULT_BREAKS_RULE) for name in out)
        yield from self._realised(report)  # last: whom it is about decides nothing else

    def _realised(self, report: RuleReport) -> Iterator[Claim]:
        """The verdicts on humans who replan: the plan is played again."""
        if report.of("replay") is not None:
            if self.result.realised:
                yield Claim("realised", "not_in_scope", wording.NO_REPLAY)
            return
        with suppress(PlanError, *UNDECIDED):  # then nothing is learned
            self._tell_pi_h(self.alone.learn)
        task, plans = self._without_rule, self.plans
        if task is not self.task:
            plans = OptimalPlans(task, alone_of(task, self.effort.deadline, self.result.options))
        claim = realised_claim(task, self.result, plans)
        if claim is not None:
            yield claim

    def _tell_pi_h(self, learn: Callable[[HumanPlan], None]) -> None:
        names = self.result.human_plan
        if names is not None:
            learn(replay_human(self.task, names, self.effort.deadline))

    def _rule_claims(self, report: RuleReport) -> Iterator[Claim]:
        claims = (report.claim_of(self.result, name, wording.FOLLOWED) for name in BY_RULES)
        yield from (claim for claim in claims if claim is not None)
        if self.result.status == "unknown" and "replay" not in report.undecided:
            yield Claim("replay", "not_in_scope", wording.NOTHING_TO_EXAMINE)
        violation = report.of("lower_bound")
        if violation is not None:
            yield Claim("lower_bound", "refuted", str(violation), seconds=report.seconds)

    def _about_pi_h(self) -> str:
        """Whether ``pi_H`` is what semantics 1 predicts; anything else must have been given.

        It decides nothing, so it takes no longer than all else did, or than ``aside_seconds`` of the limits.
        """
        deadline = self.effort.deadline
        deadline.renew(deadline.within(max(limits().aside_seconds, deadline.elapsed())))
        with suppress(*UNDECIDED):
            self._tell_pi_h(self.alone.learn)
            names = self.result.human_plan
            canonical = None if names is None else self.plans.canonical()
            if names is not None and canonical is not None:
                if names == tuple(self.task.actions[i].name for i in canonical):
                    return wording.PI_H_IS_CANONICAL
                cost = self.task.cost_of(replay_human(self.task, names, deadline))
                optimal = cost == self.task.cost_of(canonical)
                return wording.PI_H_IS_OPTIMAL if optimal else wording.PI_H_IS_GIVEN
        return ""

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
        if is_tied(self.result) and self.result.status in ("optimal", "feasible", "unknown"):
            yield from self._ties(wanted)
            return
        if self.result.mode == "individual":
            first = examiner.claim(wanted[0], self._individual)
            yield from (replace(first, claim=name, bound=None) for name in wanted)
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
                return Claim(name, proved.verdict, wording.same_as(proved), proved.counterexample)
            return examiner.claim(name, examiner.optimum_is_no_opportunity)
        if name == "optimal" and self.result.opportunity:
            return examiner.claim(name, lambda: examiner.opportunity_is_cheaper() or examiner.optimal())
        return examiner.claim(name, getattr(examiner, name))

    def _same_as(self, examined: dict[str, Claim]) -> Claim:
        """An optimum's bound is its objective (a rule): what holds for one holds for the other."""
        claim = examined.get("optimal") or examined["no_opportunity"]
        return replace(claim, claim="lower_bound", reason=wording.same_as(claim), seconds=0.0)

    def _examiner(self) -> Examiner:
        result = self.result
        names = result.human_plan
        deadline = self.effort.deadline
        plan: HumanPlan | None = None if names is None else replay_human(self.task, names, deadline)
        call = ExaminedCall(self.task, result.options, plan, self.plans, self.effort, self._free())
        if plan is not None or not call.needs_pi_h:
            assert call.horizon is not None
        sets = replay(self.task, result.plan or (), deadline, strict=result.options.strict).sets
        steps = tuple(Step(epoch, i) for epoch, chosen in sets.items() for i in chosen)
        kind = Examiner if result.options.human_model == "omniscient" else HumanExaminer
        return kind(call, result, steps, self.checker)

    def _free(self) -> ExaminedCall | None:
        """The call without rules of help, where goals say what they ask: people alone keep none."""
        task, options, names = self._without_rule, self._options, self.result.human_plan
        if task is self.task or task.robot_goal or names is None:
            return None
        plans = OptimalPlans(task, alone_of(task, self.effort.deadline, options))
        plan = replay_human(task, names, self.effort.deadline)
        return ExaminedCall(task, options, plan, plans, self.effort)

    def _individual(self) -> Verdict:
        """Mode ``individual``: the human's least cost alone, by a search over states or by a program."""
        result = self.result
        cost = cost_alone(self.task, result.options, self.effort, self.alone)
        if cost is None:
            right = result.cost is None
            return "proved" if right else "refuted", wording.NOT_ALONE, None
        right = result.lower_bound is None or excess(result.lower_bound, cost) <= 0
        exactly = agrees(result.cost, cost)
        if result.status == "feasible":
            right = right and result.cost is not None and (exactly or excess(result.cost, cost) > 0)
        elif result.status != "unknown":
            right = right and exactly
            if result.human_plan is not None:
                given = self.task.cost_of(replay_human(self.task, result.human_plan, self.effort.deadline))
                right = right and agrees(result.saving_alone, given - cost)
        return "proved" if right else "refuted", wording.LEAST_ALONE.format(float(cost)), None

    def _ties(self, wanted: list[str]) -> Iterator[Claim]:
        """What every optimal ``pi_H`` allows has to give the result's figures."""
        started, mark = perf_counter(), self.effort.mark
        try:
            verdict, reason = combined(self.task, self.result, self.effort, self.plans)
        except UNDECIDED as error:
            verdict, reason = "undecided", why(error)
        except NoProgramError:
            raise
        except UsageError as error:
            verdict, reason = "refuted", str(error)
        seconds, spent = perf_counter() - started, self.effort.since(mark)
        if verdict == "proved" and spent.method == "exhaustive":
            reason += wording.SEARCHED.format(spent.size["states"])
        if is_mean(self.result):
            wanted = ["cost", *wanted]
        for name in wanted:
            yield Claim(name, verdict, reason, None, seconds, None, *spent)
