"""Cross-validation: search, both integer programs, certificates and laws on the same calls."""

from serendipity.evaluation.crosscheck.false_certificates import FALSE_CERTIFICATES, FalseCertificates
from serendipity.evaluation.crosscheck.judges import JUDGES, Figures, Judge, compare, shows_it_too
from serendipity.testing.disagreement import Disagreement
from serendipity.testing.generator.calls import PlanCall, random_call
from serendipity.testing.shrinking import shrink
from serendipity.testing.written_case import command_line, write_case

__all__ = [
    "FALSE_CERTIFICATES",
    "JUDGES",
    "Disagreement",
    "FalseCertificates",
    "Figures",
    "Judge",
    "PlanCall",
    "command_line",
    "compare",
    "random_call",
    "shows_it_too",
    "shrink",
    "write_case",
]
