"""Verify: an opinion on results, independent of ``search``; imports ``serendipity.model`` only.

``verify.certificate`` is the way in; ``verify.rules`` checks a result without loading a solver.
"""

from importlib import import_module
from typing import Final

__all__ = ["preload"]

_LATER: Final = (
    "verify.certificate.certify",
    "verify.packed.cheapest_path",
    "verify.programs.promising.moves",
    "verify.policy",
    "highspy",
    "numpy.ma",
    "numpy.random",
    "email.parser",
)


def preload() -> None:
    """Load what certificates load as claims turn out to be hard, before a clock starts.

    These are arrays, a solver, and what reads its version.
    """
    for name in _LATER:
        import_module(name)
