"""Which moves of the agents' automata can be on a plan that is cheap and short enough, whatever the epoch."""

from verify.programs.promising.moves import keep_promising
from verify.programs.promising.team import Team, Windows

__all__ = ["Team", "Windows", "keep_promising"]
