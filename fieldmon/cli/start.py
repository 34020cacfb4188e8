"""Where the `fieldmon` command begins: Ctrl-C is a sentence from the first import on."""

from __future__ import annotations

import sys

from fieldmon.cli.stopped import STOPPED, STOPPED_CODE


def main() -> None:
    """Run the command line."""
    try:
        from fieldmon.cli.main import main as run

        run()
    except KeyboardInterrupt:
        sys.stderr.write(f"{STOPPED}\n")
        sys.exit(STOPPED_CODE)
