"""``python -m serendipity`` is the command ``serendipity``."""

from serendipity.cli.entry import run

if __name__ == "__main__":
    run()
