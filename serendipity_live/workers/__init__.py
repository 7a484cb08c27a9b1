"""Processes that plan and verify: they keep limits, can be killed at any time, and are replaced."""
