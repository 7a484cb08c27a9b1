"""Tests of ``serendipity.facade`` and of what the package shows."""
