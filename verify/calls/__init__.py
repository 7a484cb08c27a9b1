"""A call of the planner's, answered by programs alone."""
