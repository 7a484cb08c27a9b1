"""Which results integer programs alone can prove, so that there is a proof file."""

from serendipity.model import INFINITE, Result, UsageError
from verify.base.obligations import BY_RULES, needed


def require_programs(result: Result, method: str = "program") -> None:
    """Return if programs decide what rules can't.

    Args:
        result: of checked types.
        method: the one that was asked for.

    Raises:
        UsageError: they don't, or another method was asked for; the text says what decides.
    """
    if method not in ("auto", "program"):
        raise UsageError(f"proof: goes with method program, not {method}")
    decided = _decided_otherwise(result)
    if decided is not None:
        raise UsageError(f"proof: there are no programs for {decided}")


def _decided_otherwise(result: Result) -> str | None:
    options = result.options
    if result.mode == "assistance":
        return "mode assistance"
    if result.mode == "individual":
        return None
    if options.human_model != "omniscient":
        return "a human who replans"
    if result.says("goals"):
        return "goals that are not known"
    unpredicted = result.mode == "composite" and result.human_plan is None and options.horizon is None
    if options.horizon == INFINITE or unpredicted:
        return "plans without a horizon"
    return None


def main_claim(result: Result) -> str | None:
    """The claim that programs prove; None where rules do without them."""
    return next((name for name in needed(result) if name not in (*BY_RULES, "realised")), None)
