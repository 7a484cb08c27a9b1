"""Somebody else's planner against brute force and against the laws, on random calls."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

from serendipity.model import INFINITE, Deadline, PlanError, UsageError
from serendipity_testing.asking import call_of, settled, written
from serendipity_testing.call import Answered, Call
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.generator.calls import PlanCall, random_call
from serendipity_testing.judges import OutsideJudge, Proposal, fault, said
from serendipity_testing.judges.claims import TIME_LIMIT, cost_of
from serendipity_testing.judges.in_mode import as_result
from serendipity_testing.laws import ASKED_IN, JOINT, LAWS
from serendipity_testing.oracle import Optimum, best
from serendipity_testing.shrinking import shrink
from serendipity_testing.told_plans import both_plans

MODES: Final = ("serendipity", "communication", "composite", "individual")
OPTIONS: Final = (
    "discount",
    "window_weight",
    "max_window",
    "suffix",
    "preservation",
    "interference",
    "max_cost",
    "communication_weight",
    "keep_prefix",
    "horizon",
)
"""The options that calls may differ in, beside ``human_plan``."""

HUMAN_PLAN: Final = "human_plan"
BRUTE_FORCE: Final = "brute force"
JOINT_MODE: Final = "joint"


@dataclass(frozen=True, slots=True)
class Draw:
    """The random calls that a planner is asked.

    Attributes:
        options: names of the options that calls may differ in, and ``human_plan``; others are the default.
        actions: the most ground actions that a task has.
        call_limit: seconds for each call: a planner that takes longer hangs.
    """

    modes: tuple[str, ...] = ("serendipity",)
    options: tuple[str, ...] = ("discount", "window_weight")
    actions: int = 30
    seed: int = 0
    count: int = 100
    call_limit: float = 60.0

    def __post_init__(self) -> None:
        if not self.call_limit > 0:
            raise UsageError(f"call_limit: expected more than 0 seconds, got {self.call_limit:g}")
        for name, given, known in (
            ("modes", self.modes, MODES),
            ("options", self.options, (*OPTIONS, HUMAN_PLAN)),
        ):
            for word in given:
                if word not in known:
                    raise UsageError(f"{name}: expected some of {', '.join(known)}, got '{word}'")
        if not self.modes:
            raise UsageError(f"modes: expected some of {', '.join(MODES)}, got none")

    def calls(self, mode: str | None = None) -> Iterator[PlanCall]:
        """The calls of one check, in one mode or in all by turns; the same for the same scope."""
        seed, drawn = self.seed, 0
        while drawn < self.count:
            call = random_call(seed)
            if len(call.task.actions) <= self.actions:
                yield self._within(call, mode or self.modes[seed % len(self.modes)], seed)
                drawn += 1
            seed += 1

    def _within(self, call: PlanCall, mode: str, seed: int) -> PlanCall:
        options = {name: value for name, value in call.options.items() if name in self.options}
        if mode != "communication":
            options.pop("keep_prefix", None)
        if mode != "composite" and options.get("horizon") == INFINITE:
            del options["horizon"]
        if mode == "composite" and "horizon" not in options and seed % 2:
            options["horizon"] = INFINITE
        plan = call.human_plan if HUMAN_PLAN in self.options else None
        return replace(call, options={"mode": mode, **options}, human_plan=plan)


@dataclass(frozen=True, slots=True)
class Check:
    """A check: the optimum of a mode, or a law in all modes.

    Attributes:
        name: ``brute force`` or the law's.
        mode: the mode; None: by turns.
    """

    name: str
    mode: str | None = None

    def __str__(self) -> str:
        if self.name == BRUTE_FORCE:
            return f"brute-force[{self.mode}]"
        return f"law[{self.name.replace(' ', '-')}]"


@dataclass(frozen=True, slots=True)
class Probed:
    """The outcome of a check.

    Attributes:
        refused: how many of them the planner, or the oracle, had no answer to.
    """

    calls: int
    refused: int
    found: Disagreement | None = None
    seed: int | None = None


def checks(judge: OutsideJudge, scope: Draw) -> list[Check]:
    """The checks of a planner: each of its modes, and the laws that speak of them."""
    if not judge.every_mode:
        return [Check(BRUTE_FORCE, JOINT_MODE), *map(Check, JOINT)]
    modes = set(scope.modes)
    laws = [law for law in LAWS if ASKED_IN.get(law, frozenset()) <= modes]
    if not modes & {"composite", "individual"}:
        laws.remove("split cost")
    return [*(Check(BRUTE_FORCE, mode) for mode in scope.modes), *map(Check, laws)]


def run(judge: OutsideJudge, check: Check, scope: Draw) -> Probed:
    """Ask the calls of a scope in turn until something is wrong; that is made as small as may be."""
    examine = partial(_against_brute_force, judge, scope.call_limit)
    if check.name != BRUTE_FORCE:
        examine = partial(_by_law, judge, check.name, scope.call_limit)
    asked = refused = 0
    for call in scope.calls(None if check.mode == JOINT_MODE else check.mode):
        asked += 1
        try:
            found = examine(judge.fitted(call))
        except _RefusedError:
            refused += 1
            continue
        if found is not None:
            smallest = shrink(found.call, partial(_shows, examine, found.kind))
            return Probed(asked, refused, examine(smallest) or found, call.seed)
    return Probed(asked, refused)


class _RefusedError(Exception):
    """A call has no answer: the planner does not know the like, or it is none."""


class _CrashError(Exception):
    """The planner raised something."""


def _shows(examine: Callable[[PlanCall], Disagreement | None], kind: tuple[str, ...], call: PlanCall) -> bool:
    """Whether a call shows a disagreement of the same kind."""
    try:
        found = examine(call)
    except _RefusedError:
        return False
    return found is not None and found.kind == kind


_CRASH: Final = "raised "


def _against_brute_force(judge: OutsideJudge, call_limit: float, call: PlanCall) -> Disagreement | None:
    asked = _settled(call)
    crash = ""
    try:
        claim = _claim(judge, call, call_limit)
    except _CrashError as error:
        crash = str(error)
    try:
        proved = best(asked.task, asked.options, asked.human_plan)
    except UsageError:
        raise _RefusedError from None
    known = {BRUTE_FORCE: _in_words(proved, windowed=asked.options.windowed)}
    if crash:
        return Disagreement(call, known | {judge.name: crash})
    wrong = fault(call, claim, proved)
    if wrong is None:
        return None
    words = known | {judge.name: f"{said(call, claim)} (refuted: {wrong})"}
    return Disagreement(call, words, plans=both_plans(call, claim, asked.options, asked.human_plan_names))


def _by_law(judge: OutsideJudge, law: str, call_limit: float, call: PlanCall) -> Disagreement | None:
    def ask(other: Call) -> Answered:
        plain = written(other)
        claim = _claim(judge, plain, call_limit)
        if claim.plan is None:
            return Optimum("infeasible")
        if claim.epochs is None:
            cost = cost_of(plain, claim.plan)
            return Optimum("optimal", cost, cost)
        return as_result(other, claim)

    try:
        wrong = next(LAWS[law](_settled(call), ask), None)
    except _CrashError as crash:
        return Disagreement(call, {judge.name: str(crash)}, law)
    return None if wrong is None else Disagreement(call, {judge.name: wrong}, law)


def _settled(call: PlanCall) -> Call:
    try:
        return settled(call_of(call))
    except (UsageError, PlanError):
        raise _RefusedError from None


def _claim(judge: OutsideJudge, call: PlanCall, call_limit: float) -> Proposal:
    try:
        claim = judge.answer(call, Deadline(call_limit))
    except Exception as error:  # whatever it is, it is found
        raise _CrashError(f"{_CRASH}{type(error).__name__}: {error}") from error
    if claim.words == TIME_LIMIT:
        raise _CrashError(f"{_CRASH}TimeoutError: no answer within {call_limit:g} s")
    if claim.status == "unknown":
        raise _RefusedError
    return claim


def _in_words(optimum: Optimum, *, windowed: bool) -> str:
    if optimum.cost is None:
        return optimum.status
    words = f"{optimum.status}, cost {float(optimum.cost):g}"
    if windowed and not optimum.opportunity:
        return f"{words}, no help"
    if optimum.objective not in (None, optimum.cost):
        words += f", objective {float(optimum.objective or 0):g}"
    window = optimum.window
    return words if window is None else f"{words}, window [{window.start}, {window.end})"
