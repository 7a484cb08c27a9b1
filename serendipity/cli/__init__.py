"""The command line; ``serendipity.cli.app:main`` is its entry point."""
