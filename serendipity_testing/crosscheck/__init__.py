"""Cross-validation: search, both integer programs, certificates and laws on the same calls."""

from serendipity_testing.crosscheck.false_certificates import FALSE_CERTIFICATES, FalseCertificates
from serendipity_testing.crosscheck.judges import JUDGES, Figures, Judge, compare, shows_it_too
from serendipity_testing.own_laws import LAWS

__all__ = [
    "FALSE_CERTIFICATES",
    "JUDGES",
    "LAWS",
    "FalseCertificates",
    "Figures",
    "Judge",
    "compare",
    "shows_it_too",
]
