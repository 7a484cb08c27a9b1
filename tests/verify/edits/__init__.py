"""Good results of every mode, and every edit of their fields."""
