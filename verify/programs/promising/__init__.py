"""Which moves of the agents' automata can be on a plan that is cheap and short enough, whatever the epoch."""

from verify.programs.promising.moves import keep_promising
from verify.programs.promising.team import TeamMoves, Windows

__all__ = ["TeamMoves", "Windows", "keep_promising"]
