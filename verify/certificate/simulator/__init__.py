"""A small simulator of the human who replans (semantics 6), independent of ``search``."""

from verify.certificate.simulator.check import realised_claim
from verify.certificate.simulator.run import MomentOfPlay, Play, PlayedOut, play
from verify.certificate.simulator.sight import Sight

__all__ = ["MomentOfPlay", "Play", "PlayedOut", "Sight", "play", "realised_claim"]
