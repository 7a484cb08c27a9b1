"""The command line; ``serendipity.cli.entry:run`` is its entry point."""
