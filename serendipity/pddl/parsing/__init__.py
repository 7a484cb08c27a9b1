"""PDDL text to lifted values, names and types checked.

What is missing, wrong or not supported is an ``InputError`` with its line; ``files`` adds the file.
"""
