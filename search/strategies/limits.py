"""Shares of time and numbers that more than one strategy goes by."""

from typing import Final

SUGGESTIONS: Final = 0.05
"""The share of the time that is left for what one composite plan suggests in a mode with other rules."""

TIES: Final = 1_000
"""Nodes for the sake of a better window for the same objective."""

FIRST_BOUND: Final = 0.1
"""The share of the time that is left for what the team pays at least, beside a human who replans."""
