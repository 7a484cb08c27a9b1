"""The judges: independent answers to one call, and whether they agree."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import Final

from serendipity.facade.call import options_from
from serendipity.facade.certify import check, verify
from serendipity.facade.planning import plan
from serendipity.model import INFINITE, Deadline, Options, PlanError, Result, UsageError
from serendipity.model.task.gate import is_bound, needs_time
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.generator.calls import PlanCall
from serendipity_testing.judges import OutsideJudge, fault
from serendipity_testing.judges import said as said_by
from serendipity_testing.oracle import best
from serendipity_testing.oracle.truth import Truth, UnknownTruthError
from serendipity_testing.own_laws import LAWS, Law
from serendipity_testing.told_plans import claimed_plan, told_plan
from verify.base.optimal_plans import OptimalPlans
from verify.calls.solve import solve


def may_be_refused(call: PlanCall) -> bool:
    """True if an option has no legal value, a plan does not work, or a horizon is missing or too short."""
    try:
        options = options_from(call.keywords())
        told, early = call.human_plan, options.head_start
        given = None if told is None else call.task.plan_from_names(told, early)
    except (UsageError, PlanError):
        return True
    if is_bound(call.task, options):
        return _refused_by_brute_force(call, options)
    if needs_time(call.task, options=options, plan=given):
        # By the end, or after a head start, there may be no plan any more, or not the one that is given.
        return options.horizon is not None or bool(options.head_start)
    plans = OptimalPlans(call.task)
    plan = plans.canonical() if given is None else given
    tied = options.ties != "fixed" and given is None
    if tied and len(list(islice(plans.plans(), options.max_ties + 1))) > options.max_ties:
        return True
    return _lacks_horizon(call, options, None if plan is None else len(plan))


def _refused_by_brute_force(call: PlanCall, options: Options) -> bool:
    given = None if call.human_plan is None else call.task.plan_from_names(call.human_plan)
    try:
        best(call.task, options, given)
    except (UsageError, PlanError):
        return True
    return False


def _lacks_horizon(call: PlanCall, options: Options, length: int | None) -> bool:
    """Semantics 2, 3.5; ``length`` is that of ``pi_H``, None where there is none."""
    if options.horizon is not None:
        return options.horizon != INFINITE and length is not None and int(options.horizon) < length
    if length is None:
        return options.mode == "communication"
    return length == 0 and not call.task.robot_goal.holds(call.task.init)


@dataclass(frozen=True, slots=True)
class Figures:
    """The figures that judges have to agree on; ``error`` where the call is refused."""

    status: str = "error"
    cost: float | None = None
    objective: float | None = None
    opportunity: bool = False
    saving: float | None = None

    def __str__(self) -> str:
        if self.status in ("error", "infeasible"):
            return self.status
        words = f"{self.status}, cost {self.cost}, objective {self.objective}"
        return f"{words}, opportunity" if self.opportunity else words


BRUTE_FORCE: Final = "brute force"
"""Who says what is best where no program does: beside humans who replan in time, and under rules of help."""

Judge = Callable[[PlanCall, Deadline], Result]


def _by_search(call: PlanCall, deadline: Deadline) -> Result:
    return plan(call.task, human_plan=call.human_plan, deadline=deadline, **call.keywords())


def _by_verifier(call: PlanCall, deadline: Deadline, **how: str) -> Result:
    options = options_from(call.keywords())
    return solve(call.task, options, human_plan=call.human_plan, deadline=deadline, **how)


JUDGES: Final[dict[str, Judge]] = {
    "search": _by_search,
    "automata": _by_verifier,
    "paper": partial(_by_verifier, encoding="paper"),
    "cbc": partial(_by_verifier, solver="cbc"),
    "program": partial(_by_verifier, method="program"),
    "exhaustive": partial(_by_verifier, method="exhaustive"),
}
"""Judges by name; the first has to obey the laws, and is the only one that knows humans who replan."""


def compare(
    call: PlanCall,
    judges: Mapping[str, Judge],
    laws: Mapping[str, Law] = LAWS,
    *,
    outside: Sequence[OutsideJudge] = (),
    time_limit: float | None = None,
    memory_limit: float | None = None,
) -> Disagreement | None:
    """Let every judge answer, and the verifier certify the answers; hold the search to its laws.

    What follows from the figures is proved once for each of them.  Whatever a judge raises but a
    refusal is a disagreement, too.  A judge that a limit stops before the proof agrees with
    everybody, but its answer has to follow the rules; laws are for calls without limits.

    Args:
        judges: by name.
        laws: by name.
        outside: judges from outside; what is asked then is what they can be asked about the call's task.
        time_limit: seconds for each answer, and for each certificate; or None.
        memory_limit: what the process may have in memory, in MiB, or None.
    """
    for stranger in outside:
        call = stranger.fitted(call)
    limits = partial(Deadline, time_limit, memory_limit)
    said: dict[str, str] = {}
    known: set[Figures] = set()
    answers: dict[str, Result] = {}
    sound = True
    for name, judge in judges.items():
        if name != "search" and _only_verified(call):
            continue
        figures, words, answer = _asked(call, judge, known, limits)
        said[name] = words
        sound = sound and figures is not None
        if figures is not None and figures.status not in ("unknown", "feasible"):
            known.add(figures)
        if answer is not None:
            answers[name] = answer
    proved = next((a for a in answers.values() if a.status in ("optimal", "infeasible")), None)
    plans: dict[str, str] = {}
    for stranger in outside:
        words, agrees, its_plan = _asked_outside(call, stranger, proved, limits)
        said[stranger.name] = words
        sound = sound and agrees
        plans |= its_plan
    wrong = _misjudged(call, answers.get("search"))
    if wrong is not None:
        said[BRUTE_FORCE], sound = wrong, False
    if not sound or len(known) > 1:
        ours = told_plan(proved) if plans and proved is not None else {}
        return Disagreement(call, said, plans=plans | ours)
    if "search" in answers and time_limit is None and memory_limit is None:
        for law, fault in _broken(call, answers["search"], laws):
            return Disagreement(call, {"search": said["search"], law: fault}, law)
    return None


def shows_it_too(
    found: Disagreement,
    judges: Mapping[str, Judge],
    *,
    outside: Sequence[OutsideJudge] = (),
    time_limit: float | None = None,
    memory_limit: float | None = None,
) -> Callable[[PlanCall], bool]:
    """A test of other calls: whether the same judges are at fault in the same way, or the same law is broken.

    Args:
        found: the disagreement.
        judges: by name.
        outside: judges from outside.
        time_limit: seconds for each answer and certificate, or None.
        memory_limit: what the process may have in memory, in MiB, or None.
    """
    search = {"search": judges["search"]} if found.law is not None else {}

    def shows(call: PlanCall) -> bool:
        if found.law is not None:
            again = compare(call, search, {found.law: LAWS[found.law]})
        else:
            again = compare(
                call, judges, {}, outside=outside, time_limit=time_limit, memory_limit=memory_limit
            )
        return again is not None and again.kind == found.kind

    return shows


def _asked(
    call: PlanCall, judge: Judge, proved: Collection[Figures], limits: Callable[[], Deadline]
) -> tuple[Figures | None, str, Result | None]:
    """A judge's answer: as figures (None: it can't be so), in words, and as a result if it is one."""
    refuted = None
    try:
        result = judge(call, limits())
        if result.status != "unknown":
            examine = check if figures_of(result) in proved else verify
            refuted = examine(call.task, result, deadline=limits()).refuted
    except (UsageError, PlanError) as error:
        known = may_be_refused(call)
        return Figures() if known else None, str(Figures() if known else error), None
    except Exception as error:  # whatever it is, it is found
        return None, _crash(error), None
    figures = figures_of(result)
    if refuted is not None:
        return None, f"{figures} (refuted: {refuted.claim}: {refuted.reason})", result
    return figures, str(figures), result if result.status != "unknown" else None


def _only_verified(call: PlanCall) -> bool:
    """Whether no program answers: it knows neither what a human does who replans, nor rules of help.

    The verifier does, and so does brute force.
    """
    try:
        options = options_from(call.keywords())
    except UsageError:
        return False
    return options.human_model != "omniscient" or is_bound(call.task, options)


def _misjudged(call: PlanCall, answer: Result | None) -> str | None:
    """What is not so of an answer that no program knows, by brute force; None where all is."""
    if answer is None:
        return None
    in_time = answer.options.human_model != "omniscient" and call.task.needs_time
    if not in_time and not is_bound(call.task, answer.options):
        return None
    try:
        return Truth(call.task).fault(answer)
    except (UnknownTruthError, UsageError, PlanError):
        return None


def _asked_outside(
    call: PlanCall, judge: OutsideJudge, proved: Result | None, limits: Callable[[], Deadline]
) -> tuple[str, bool, dict[str, str]]:
    """An outside judge's answer in words, True if it can be so, and its plan if that can't."""
    try:
        claim = judge.answer(call, limits())
        wrong = fault(call, claim, proved)
    except Exception as error:  # whatever it is, it is found
        return _crash(error), False, {}
    words = said_by(call, claim)
    if wrong is None:
        return words, True, {}
    return f"{words} (refuted: {wrong})", False, claimed_plan(call, claim, judge.name)


def _broken(call: PlanCall, answer: Result, laws: Mapping[str, Law]) -> Iterator[tuple[str, str]]:
    """The laws that an answer of the search breaks, and how."""
    for name, law in laws.items():
        try:
            fault = next(law(call, answer), None)
        except Exception as error:  # whatever it is, it is found
            fault = _crash(error)
        if fault is not None:
            yield name, fault


def _crash(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"


def figures_of(result: Result) -> Figures:
    """The figures of a result."""
    return Figures(result.status, result.cost, result.objective, result.opportunity, result.saving)
