"""Cross-validation: search, both integer programs, certificates and laws on the same calls."""

from serendipity.evaluation.crosscheck.judges import JUDGES, Figures, compare, shows_it_too
from serendipity.testing.disagreement import Disagreement
from serendipity.testing.generator.calls import PlanCall, random_call
from serendipity.testing.shrinking import shrink
from serendipity.testing.written_case import command_line, write_case

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
