"""What a call may use: time and memory, and how they are watched."""
