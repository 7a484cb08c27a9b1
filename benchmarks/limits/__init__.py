"""How well limits are kept: commands on tasks."""
