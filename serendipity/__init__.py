"""Serendipity: plan help for a person who did not ask, and prove that none is better."""
