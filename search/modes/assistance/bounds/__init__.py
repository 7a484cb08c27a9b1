"""Values that no policy undercuts, and values that some plan attains."""
