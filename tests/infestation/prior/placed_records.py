"""Records for tests, placed on a rectangle of plants."""

import numpy as np
from hypothesis import strategies as st

from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import ABSENT, PRESENT, Records
from fieldmon.plot.layout import rectangle

TODAY = np.datetime64("2026-05-20")
USUAL = PriorSettings()
GRID = rectangle(21, 25)
MIDDLE = len(GRID) // 2


def records(xy_m, present, age_days=0.0, grid=GRID, **columns):
    xy_m = np.asarray(xy_m, float).reshape(-1, 2)
    m = len(xy_m)
    ages = np.broadcast_to(np.asarray(age_days), m).astype(int)
    full = {name: np.broadcast_to(np.asarray(v, float), m).copy() for name, v in columns.items()}
    return Records.of(
        grid.frame.lonlat(xy_m), np.broadcast_to(present, m).copy(), TODAY - ages, **full
    )


def together(*several):
    names = vars(several[0])
    return Records(**{n: np.concatenate([getattr(o, n) for o in several]) for n in names})


def at_middle(present, age_days=0, **columns):
    return records(GRID.xy_m[MIDDLE], present, age_days, **columns)


some_records = st.lists(
    st.tuples(
        st.floats(-45, 45),
        st.floats(-45, 45),
        st.sampled_from((ABSENT, PRESENT)),
        st.integers(0, 60),
        st.sampled_from((np.nan, 0.0, 1.0, 30.0, 1e4)),
        st.sampled_from((np.nan, 0.0, 0.02, 3.0, 40.0)),
        st.sampled_from((np.nan, 0.0, 1.0, 20.0, 1e5)),
    ),
    min_size=1,
    max_size=12,
).map(
    lambda rows: records(
        [row[:2] for row in rows],
        np.array([row[2] for row in rows], np.int8),
        [row[3] for row in rows],
        count=[row[4] for row in rows],
        accuracy_m=[row[5] for row in rows],
        leaves_sampled=[row[6] for row in rows],
    )
)
