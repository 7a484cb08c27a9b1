"""Runs the registry over a result."""

import time

from serendipity.model import Deadline, Result, Task
from serendipity.model.errors import LIMITS
from verify.base import wording
from verify.base.beside_script import alone_of
from verify.base.individual import IndividualOptimum
from verify.base.undecided import UndecidedError, during, why
from verify.rules.case import CheckedResult
from verify.rules.registry import RULES, NamedRule
from verify.rules.report import CLAIMS, RuleReport, Violation


class Checker:
    """Checks results for one task; its tables of the human alone are kept between calls."""

    def __init__(self, task: Task, alone: IndividualOptimum | None = None) -> None:
        """``alone``: tables to share; None makes new ones."""
        self._task = task
        self._alone = IndividualOptimum(task) if alone is None else alone

    def check(self, result: Result) -> RuleReport:
        """The verdict of every rule that applies to ``result``, as far as the limits go."""
        started = time.perf_counter()
        examination = _Examination(CheckedResult(self._task, result, self._alone))
        try:
            with during("checking the rules"):
                for rule in RULES:
                    self._alone.deadline.check()
                    examination.check(rule)
        except LIMITS as limit:
            examination.stop(why(limit))
        return examination.report(time.perf_counter() - started)


class _Examination:
    """What is known of one result, rule by rule."""

    def __init__(self, case: CheckedResult) -> None:
        self._case = case
        self._examined: list[NamedRule] = []
        self._violations: dict[str, Violation] = {}
        self._unchecked = dict(_out_of_scope(case.result))
        self._undecided: dict[str, str] = {}

    def check(self, rule: NamedRule) -> None:
        """Check a rule, unless nothing depends on it any more."""
        claim = rule.claim
        if claim in ("cost", "window") and "replay" in self._violations:
            self._unchecked.setdefault(claim, wording.NO_REPLAY)
        if claim not in self._unchecked and claim not in self._violations:
            try:
                found = rule.check(self._case)
            except UndecidedError as error:
                self._undecided.setdefault(claim, why(error))
            else:
                if found is not None:
                    self._violations[claim] = Violation(rule.name, claim, rule.section, *found)
        self._examined.append(rule)

    def stop(self, reason: str) -> None:
        """Leave the claims undecided of which not every rule was examined."""
        for rule in RULES[len(self._examined) :]:
            if rule.claim not in self._unchecked:
                self._undecided.setdefault(rule.claim, reason)

    def report(self, seconds: float) -> RuleReport:
        """The verdicts; a claim that is refuted is not undecided."""
        undecided = {k: why for k, why in self._undecided.items() if k not in self._violations}
        return RuleReport(tuple(self._violations.values()), self._unchecked, undecided, seconds)


def check(task: Task, result: Result, deadline: Deadline | None = None) -> RuleReport:
    """Check a result rule by rule, without solving anything.

    Args:
        task: the task that the result answers.
        result: the result, as ``plan`` returned it or as it was read from a file.
        deadline: what is not checked by then stays undecided.
    """
    return Checker(task, alone_of(task, deadline, result.options)).check(result)


def _out_of_scope(result: Result) -> list[tuple[str, str]]:
    if result.mode == "assistance":
        return [(claim, wording.POLICY) for claim in CLAIMS]
    if result.options.human_model != "omniscient":
        return [("window", wording.NO_WINDOW_FOR_HIM)]
    return []
