"""The human by themselves: optimal plans, pattern databases, what they may do at the end."""
