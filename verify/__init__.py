"""Verify: an opinion on results, independent of ``search``; imports ``serendipity.model`` only.

``verify.certificate`` is the way in; ``verify.rules`` checks a result without loading a solver.

What docstrings do not repeat (nor what ``Deadline`` says of limits): who can't find out what is asked, or
would have to look at too much for it, raises ``UndecidedError`` or one of its kinds, over packed states
``TooManyPackedStatesError``.  ``plans`` are the human's optimal ones; ``original`` is the task as it was
given, where ``task`` is in single epochs; ``strict`` is interference as in semantics 2, ``xi2`` where a
suffix begins.
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
