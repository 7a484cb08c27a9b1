"""Robots by themselves: transition graphs of their variables, decoupled walks."""
