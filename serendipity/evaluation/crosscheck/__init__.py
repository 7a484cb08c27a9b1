"""Cross-validation: search, both integer programs, certificates and laws on the same calls."""

from serendipity.evaluation.crosscheck.calls import PlanCall, random_call
from serendipity.evaluation.crosscheck.judges import JUDGES, Disagreement, Figures, compare, shows_it_too
from serendipity.evaluation.crosscheck.reproduce import command_line, write_case
from serendipity.evaluation.crosscheck.shrink import shrink

__all__ = [
    "JUDGES",
    "Disagreement",
    "Figures",
    "PlanCall",
    "command_line",
    "compare",
    "random_call",
    "shows_it_too",
    "shrink",
    "write_case",
]
