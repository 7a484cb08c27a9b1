"""Cross-validation: search, both integer programs and the certificate on the same calls."""

from serendipity.crosscheck.calls import PlanCall, random_call
from serendipity.crosscheck.judges import JUDGES, Disagreement, Figures, compare
from serendipity.crosscheck.reproduce import command_line, write_case
from serendipity.crosscheck.shrink import shrink

__all__ = [
    "JUDGES",
    "Disagreement",
    "Figures",
    "PlanCall",
    "command_line",
    "compare",
    "random_call",
    "shrink",
    "write_case",
]
