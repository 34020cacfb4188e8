"""The sample estate is found beside the app, wherever that is."""

import numpy as np

from app.state import sample_estate
from fieldmon.io.read import read_records
from tests.paths import SAMPLE_DATA


def test_its_files_are_where_the_repository_has_them():
    assert sample_estate.FOLDER == SAMPLE_DATA
    for name in (sample_estate.PLOTS, sample_estate.RECORDS, sample_estate.PATHS):
        assert (sample_estate.FOLDER / name).is_file()


def test_its_plots_are_read_once():
    assert sample_estate.plots() is sample_estate.plots()
    assert sample_estate.plots()[0].name == "Gate"


def test_its_day_is_within_its_records():
    days = read_records(SAMPLE_DATA / sample_estate.RECORDS).value.day
    assert days.min() < np.datetime64(sample_estate.LAST_DAY) <= days.max()
