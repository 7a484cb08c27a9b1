"""The signals that ask a process to end."""

import signal

SIGNALS = (signal.SIGINT, signal.SIGTERM)
"""Ctrl-C; and ``kill``, ``timeout``, containers and schedulers."""
