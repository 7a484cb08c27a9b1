"""A prepared task, and the context of a call, which all of its searches share."""
