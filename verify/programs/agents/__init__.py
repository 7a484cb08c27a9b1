"""Automata of agents: what each of them can make of the facts that nobody else changes."""
