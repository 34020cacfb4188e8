"""The curves of the study with prior information are its seeds' means."""

import numpy as np

from app.show.study_curves import curves
from fieldmon.studies.thesis.chapter5.study import label_of, run_prior


def test_a_column_a_configuration_is_the_mean_of_its_seeds_from_day_one():
    (part,) = run_prior(("A",), 2).parts
    table = curves(part)
    assert table.index[0] == 1
    assert len(table.columns) == len(part.runs)
    for runs in part.runs:
        own = table[label_of(part.name, runs.trial)]
        assert own.tolist() == np.mean(runs.detection_pct, axis=0).tolist()
