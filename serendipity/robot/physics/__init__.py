"""Robots as figures in physics, by Bullet (the optional extra ``robot``)."""

from serendipity.robot.physics.film import FORMATS, Film, check_format
from serendipity.robot.physics.stage import Stage

__all__ = ["FORMATS", "Film", "Stage", "check_format"]
