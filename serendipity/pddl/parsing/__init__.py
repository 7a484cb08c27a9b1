"""PDDL text to lifted values, names and types checked, each error with its line."""
