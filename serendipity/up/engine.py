"""The engine, where files that name engines of unified-planning look for it."""

from serendipity_up.engine import SerendipityEngine

__all__ = ["SerendipityEngine"]
