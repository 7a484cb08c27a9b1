"""A small simulator of the human who replans (SPEC 6), independent of ``search``."""

from verify.simulator.check import realised_claim
from verify.simulator.person import Person
from verify.simulator.run import Played, play

__all__ = ["Person", "Played", "play", "realised_claim"]
