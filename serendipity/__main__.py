"""``python -m serendipity`` is the command ``serendipity``."""

import sys

from serendipity.cli.app import main

sys.exit(main())
