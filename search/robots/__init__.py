"""What robots can do by themselves: transition graphs of variables, decoupled ways."""
