"""Judges from outside: functions, commands and engines of other people.

``by_function``, ``by_name`` and ``by_command`` make judges; ``fault`` says why a claim can't be so.
"""

from serendipity_testing.judges.claims import OutsideJudge, Proposal, said
from serendipity_testing.judges.functions import Answer, by_function
from serendipity_testing.judges.in_mode import fault
from serendipity_testing.judges.named import by_command, by_name

__all__ = ["Answer", "OutsideJudge", "Proposal", "by_command", "by_function", "by_name", "fault", "said"]
