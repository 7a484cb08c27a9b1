"""What every search of one call shares: a prepared task, and the context of a call."""
