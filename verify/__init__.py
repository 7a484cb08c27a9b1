"""Verify: an opinion on results, independent of ``search``; imports ``serendipity.model`` only.

Names are imported when they are first used, so that the rule checker does not load a solver.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verify.calls.solve import solve
    from verify.certificate.certify import certify
    from verify.rules import Checker, RuleReport, Violation, check

__all__ = ["Checker", "RuleReport", "Violation", "certify", "check", "solve"]

_HOMES = {
    "Checker": "verify.rules",
    "RuleReport": "verify.rules",
    "Violation": "verify.rules",
    "certify": "verify.certificate.certify",
    "check": "verify.rules",
    "solve": "verify.calls.solve",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
