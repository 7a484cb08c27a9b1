"""``python -m serendipity`` is the command ``serendipity``."""

import os
import sys

if sys.path and sys.path[0] == os.getcwd():  # noqa: PTH109 - what lies there must not come first
    sys.path.append(sys.path.pop(0))

from serendipity.cli.entry import run

if __name__ == "__main__":
    run()
