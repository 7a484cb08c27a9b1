"""Judges from outside: functions, commands and engines of other people."""

from serendipity.testing.judges.claims import Claim, OutsideJudge, fault, said
from serendipity.testing.judges.named import by_command, by_name

__all__ = ["Claim", "OutsideJudge", "by_command", "by_name", "fault", "said"]
"""``by_name`` and ``by_command`` make judges of what a user names."""
