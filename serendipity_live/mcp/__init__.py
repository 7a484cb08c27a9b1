"""For agents that talk: calls of the planner as tools of the Model Context Protocol."""
