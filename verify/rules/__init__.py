"""The rule checker: replays a result and names the first rule that it breaks.

Written from ``docs/semantics.md`` sections 1-3 alone; it shares nothing with
``search``.  What it can't say without solving (is there a better plan?) it leaves to
the integer programs.
"""

from verify.rules.checker import Checker, check
from verify.rules.registry import RULES, NamedRule
from verify.rules.report import CLAIMS, RuleReport, Violation

__all__ = ["CLAIMS", "RULES", "Checker", "NamedRule", "RuleReport", "Violation", "check"]
