"""What every proof rests on: the question asked, the human's own optima, rules of concurrency, limits."""
