"""A task in machine words: operators, successor generator, lexicographic costs."""
