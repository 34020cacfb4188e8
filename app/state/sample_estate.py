"""The made-up estate that comes with the program: its files, and the day it ends on.

Little is imported here: its outline is what a first page shows. No Streamlit in here.
"""

from __future__ import annotations

from datetime import date
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.io import read

if TYPE_CHECKING:
    from fieldmon.plot.field import Field

_APP = Path(__file__).resolve().parents[1]
#: beside the app: `app` and `sample_data` in the repository, `_app` and `_sample_data` installed
FOLDER = _APP.with_name(_APP.name.replace("app", "sample_data"))
PLOTS, RECORDS, PATHS = "paran_estate.zip", "mite_records.csv", "tracks.geojson"
LAST_DAY = date(2026, 11, 16)


@cache
def plots() -> tuple[Field, ...]:
    """Return the plots of the estate."""
    return read.read_plots(FOLDER / PLOTS).value
