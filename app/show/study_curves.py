"""The curves of the study with prior information. No Streamlit in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from fieldmon.studies.thesis.chapter5.study import label_of

if TYPE_CHECKING:
    from fieldmon.studies.thesis.chapter5.study import StudyPart


def curves(part: StudyPart) -> pd.DataFrame:
    """Return the mean detection day by day, a column a configuration."""
    columns = {}
    for runs in part.runs:
        name = label_of(part.name, runs.trial)
        size = f", {runs.trial.hectares:g} ha" if part.name == "size" else ""
        columns[name + size] = runs.detection_pct.mean(axis=0)
    table = pd.DataFrame(columns)
    table.index += 1
    return table
