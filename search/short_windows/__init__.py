"""Windows of one epoch, where longer ones can not be better (semantics 3.1)."""
