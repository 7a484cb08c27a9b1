"""From the rules' verdict to claims of a certificate: ``check`` and ``verify`` make them alike."""

from collections.abc import Mapping

from serendipity.model import Claim, Result
from verify.rules.report import RuleReport


def rule_claim(result: Result, report: RuleReport, name: str, followed: Mapping[str, str]) -> Claim | None:
    """One claim as far as rules decide it; None where they say nothing of it.

    Args:
        followed: what is said of claims that following the rules proves, where there is a plan.
    """
    violation = report.of(name)
    if violation is not None:
        return Claim(name, "refuted", str(violation), seconds=report.seconds)
    if name in report.unchecked:
        return Claim(name, "not_in_scope", report.unchecked[name])
    if name in report.undecided and (name == "replay" or result.plan is not None):
        return Claim(name, "undecided", report.undecided[name], seconds=report.seconds)
    if name in followed and result.plan is not None:
        return Claim(name, "proved", followed[name], seconds=report.seconds)
    return None
