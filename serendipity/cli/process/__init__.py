"""The process around a command: signals, and how it ends."""
