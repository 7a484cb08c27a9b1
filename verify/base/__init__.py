"""What every proof rests on: the question asked, the human's own optima, what a step means, limits."""
