"""Values that no policy undercuts."""
