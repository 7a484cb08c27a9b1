"""What is asked of the planner: each call with its options checked, and its answer."""
