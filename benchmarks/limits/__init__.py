"""How limits of time and memory are kept: studies of commands as processes."""
