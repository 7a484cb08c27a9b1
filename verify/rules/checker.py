"""Runs the registry over a result."""

import time

from serendipity.model import Result, Task
from verify.rules.alone import Alone
from verify.rules.case import Case
from verify.rules.registry import RULES
from verify.rules.report import CLAIMS, RuleReport, Violation


class Checker:
    """Checks results for one task; its tables of the human alone are kept between calls."""

    def __init__(self, task: Task, alone: Alone | None = None) -> None:
        """``alone``: tables to share; None makes new ones."""
        self._task = task
        self._alone = Alone(task) if alone is None else alone

    def check(self, result: Result) -> RuleReport:
        """The verdict of every rule that applies to ``result``."""
        started = time.perf_counter()
        case = Case(self._task, result, self._alone)
        violations: list[Violation] = []
        unchecked = dict(_out_of_scope(result))
        for rule in RULES:
            if rule.claim in unchecked or any(v.claim == rule.claim for v in violations):
                continue
            if rule.claim in ("cost", "window") and any(v.claim == "replay" for v in violations):
                unchecked[rule.claim] = "the plan can't be replayed"
                continue
            found = rule.check(case)
            if found is not None:
                violations.append(Violation(rule.name, rule.claim, rule.section, *found))
        return RuleReport(tuple(violations), unchecked, time.perf_counter() - started)


def check(task: Task, result: Result) -> RuleReport:
    """Check a result rule by rule, without solving anything.

    Args:
        task: the task that the result answers.
        result: the result, as ``plan`` returned it or as it was read from a file.
    """
    return Checker(task).check(result)


def _out_of_scope(result: Result) -> list[tuple[str, str]]:
    if result.mode == "assistance":
        return [(claim, "a policy, not a plan") for claim in CLAIMS]
    if result.options.human_model != "omniscient":
        return [("window", "a human who replans is not bound to a window")]
    return []
