"""Judges from outside: functions, commands and engines of other people."""

from serendipity.evaluation.crosscheck.outside.claims import Claim, OutsideJudge, fault, said
from serendipity.evaluation.crosscheck.outside.named import by_command, by_name

__all__ = ["Claim", "OutsideJudge", "by_command", "by_name", "fault", "said"]
"""``by_name`` and ``by_command`` make judges of what a user names."""
