"""Proof files: integer programs that nothing satisfies, and why, for anybody to check with integers."""
