"""A small simulator of the human who replans (semantics 6), independent of ``search``."""

from verify.certificate.simulator.check import realised_claim
from verify.certificate.simulator.person import ReplanningPerson
from verify.certificate.simulator.run import MomentOfPlay, Play, PlayedOut, play

__all__ = ["MomentOfPlay", "Play", "PlayedOut", "ReplanningPerson", "play", "realised_claim"]
