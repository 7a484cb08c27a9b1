"""What commands are told: tasks, modes, programs, limits."""
