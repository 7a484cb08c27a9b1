"""The calls of the library: options checked, answers made into results."""
