"""Integer programs for a question: the paper's own (``paper``) and a strong one (``automata``)."""
