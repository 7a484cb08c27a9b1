"""Tests of ``serendipity.model``."""
