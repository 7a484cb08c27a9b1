"""Tests of ``search``, through the calls that it answers."""
