"""Serendipity for unified-planning (extra ``up``), as programs import it: ``serendipity_up``.

Importing this registers the engine ``serendipity``.
"""

from serendipity_up import *  # noqa: F403
from serendipity_up import __all__ as __all__
