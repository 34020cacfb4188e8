"""Plants found twice stand much nearer than plants do."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.io.import_report import Severity
from fieldmon.io.options import ReadOptions
from fieldmon.io.readers.points_and_lines import plants_of
from fieldmon.plot.near_doubles import near_doubles
from fieldmon.plot.projection import Frame
from tests.io.tables_of_cells import table

FRAME = Frame(35.1, 31.5)


def rows(row_m=3.0, plant_m=1.5):
    row, plant = np.divmod(np.arange(120), 20)
    return np.c_[plant * plant_m, row * row_m]


@pytest.mark.parametrize("off_m", [0.08, 0.2, 0.5])
def test_plants_found_twice_are_doubted_and_one_of_each_is_kept_as_offered(off_m):
    lon, lat = FRAME.lonlat(np.r_[rows(), rows()[::10] + np.array([0.0, off_m])]).T.tolist()
    layer = table(lon=lon, lat=lat)
    (doubt,) = plants_of(layer, ReadOptions()).of(Severity.DOUBTFUL)
    assert "24 of 132 plants stand within" in doubt.sentence
    mended = plants_of(layer, ReadOptions().choose(doubt.remedy.option, doubt.remedy.value))
    assert len(mended.value) == 120
    assert not mended.of(Severity.DOUBTFUL)


def test_double_rows_and_plants_that_stand_anyhow_are_none():
    double = np.r_[rows(), rows() + np.array([0.0, 0.4])]
    anyhow = np.random.default_rng(1).random((300, 2)) * 100
    for xy_m in (rows(), double, anyhow):
        assert near_doubles(FRAME.lonlat(xy_m)) is None


@pytest.mark.parametrize("said", ["two", "0", "-1", "99", "nan"])
def test_a_distance_of_doubles_is_some_metres(said):
    with pytest.raises(SettingError, match="doubles must be one"):
        ReadOptions(doubles=said)
