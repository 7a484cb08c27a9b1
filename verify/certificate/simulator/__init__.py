"""A small simulator of the human who replans (semantics 6), independent of ``search``."""

from verify.certificate.simulator.check import realised_claim
from verify.certificate.simulator.person import Person
from verify.certificate.simulator.run import Moment, Play, Played, play

__all__ = ["Moment", "Person", "Play", "Played", "play", "realised_claim"]
