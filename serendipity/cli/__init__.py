"""The command line; ``serendipity.cli.entry:run`` is its entry point.

What was typed wrongly is a ``UsageError``, a file that is wrong an ``InputError`` with its name, line or key:
``app`` makes one line and an exit code of each.
"""
