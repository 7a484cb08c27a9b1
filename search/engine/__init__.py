"""What every search is made of: the best-first loop, dominance, outcomes."""
