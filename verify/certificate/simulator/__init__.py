"""A small simulator of the human who replans (semantics 6), independent of ``search``."""

from verify.certificate.simulator.check import realised_claim
from verify.certificate.simulator.run import MomentOfPlay, Play, PlayedOut, play
from verify.certificate.simulator.sight import LocalSight

__all__ = ["LocalSight", "MomentOfPlay", "Play", "PlayedOut", "play", "realised_claim"]
