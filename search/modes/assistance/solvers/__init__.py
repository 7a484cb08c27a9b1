"""A* for a chosen prime, LAO* and policy iteration for one who chooses."""
