"""Which results integer programs alone can prove, so that there is a proof file."""

from serendipity.model import INFINITE, Result, UsageError
from verify.base.obligations import BY_RULES, needed
from verify.programs.effort import NoProgramError


def require_programs(result: Result, method: str = "program") -> None:
    """Return if programs may decide what rules can't.

    Of humans who replan, and of several goals, they decide some answers; that turns out on the way.

    Raises:
        UsageError: they don't, or another method was asked for; the text says what decides.
    """
    if method not in ("auto", "program"):
        raise UsageError(f"proof: goes with method program, not {method}")
    if result.mode == "assistance":
        raise NoProgramError("mode assistance")
    horizon = result.options.horizon
    unpredicted = result.mode == "composite" and result.human_plan is None and horizon is None
    if result.mode != "individual" and (horizon == INFINITE or unpredicted):
        raise NoProgramError("plans without a horizon")


def main_claim(result: Result) -> str | None:
    """The claim that programs prove; None where rules do without them."""
    return next((name for name in needed(result) if name not in (*BY_RULES, "realised")), None)
