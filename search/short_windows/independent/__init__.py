"""Decoupled search: robots each on its own while the human follows ``pi_H``, for bounds and answers."""
