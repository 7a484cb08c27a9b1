"""Tests; see README.md for the map."""
