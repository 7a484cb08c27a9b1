"""What tests are made of: tasks, random calls, brute force, deadlines that run out."""
