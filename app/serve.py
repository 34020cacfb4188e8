"""What `fieldmon app` starts: Streamlit, and the process that reads files, which loads meanwhile.

Streamlit loads the app's own libraries when somebody first opens a page.
"""

from __future__ import annotations

import sys

from fieldmon.geodata import guard


def main() -> None:
    """Run Streamlit with this program's arguments."""
    guard.warm()  # the first thing that the first page waits for
    from streamlit.web import cli  # noqa: PLC0415 - half a second, in which the other one loads too

    sys.exit(cli.main())


if __name__ == "__main__":
    main()
