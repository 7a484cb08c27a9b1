"""What planners are tested with."""
