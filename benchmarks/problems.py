"""Where the problems of others are, which are not part of this repository."""

import os
from pathlib import Path

PROBLEMS = Path(os.environ.get("SERENDIPITY_PROBLEMS") or Path(__file__).resolve().parents[2] / "shared")
"""The folder with ``usar200``, ``codmap15`` and ``spa``, as far as they are there.

``SERENDIPITY_PROBLEMS`` names it; without, it is ``../shared``, beside the checkout.
"""
