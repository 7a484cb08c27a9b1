"""Planners for a single agent, as processes: what others have made and somebody has installed."""
