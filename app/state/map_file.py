"""The script that draws maps in the browser, built ahead (see `app/map_view`), and its address."""

from __future__ import annotations

import hashlib
from pathlib import Path

FILE = Path(__file__).parents[1] / "map_view" / "map_view.js"
#: changes with the script, so that no browser keeps an old one
ADDRESS = f"/map_view/{hashlib.sha256(FILE.read_bytes()).hexdigest()[:16]}.js"
