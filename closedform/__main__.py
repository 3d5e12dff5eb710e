"""``python -m closedform``."""

import sys

from closedform.cli.commands import main

if __name__ == "__main__":
    sys.exit(main())
