"""Runs of chapter 5 whose detection is known."""

import numpy as np

from fieldmon.studies.thesis.chapter5.open_choices import OpenChoices
from fieldmon.studies.thesis.chapter5.replicates import PriorRuns
from fieldmon.studies.thesis.chapter5.seasons import PriorTrial


def made_up_runs(detection, visited=()):
    """Return runs whose finds make given detection curves, of 100 insects on 1000 plants."""
    detection = np.asarray(detection, float)
    tables = np.zeros((*detection.shape, 9))
    tables[..., 1] = np.diff(detection, axis=1, prepend=0)
    tables[:, 0, 3] = 100
    tables[..., 0] = visited if len(visited) else 10
    return PriorRuns(PriorTrial("dynamic", OpenChoices(), 1.0), 1000, tables)
