"""A person in time who follows a plan of their own, and looks up when free (semantics 10.6)."""
