"""Records up to a day."""

import numpy as np
import pytest
import streamlit as st

from app.show.records import records_until
from app.state.chosen_units import units
from fieldmon.infestation.records import Records
from tests.app.chosen import a_plot

DAYS = ["2026-11-01", "2026-11-05", "2026-11-09", "NaT"]


@pytest.fixture
def records():
    here = a_plot().grid.lonlat()[:4]
    return Records.of(here, np.array([1, 0, 1, 0], np.int8), np.array(DAYS, "datetime64[D]"))


@pytest.mark.parametrize(
    ("until", "shown", "pests"), [("2026-11-01", 2, 1), ("2026-11-06", 3, 1), ("2026-11-09", 4, 2)]
)
def test_records_of_later_days_are_left_out_undated_ones_never(
    records, monkeypatch, until, shown, pests
):
    asked = []

    def slider(_label, first, last, value, key, format):  # noqa: A002 - Streamlit's word
        asked.append((first, last, value, key, format))
        return np.datetime64(until).item()

    monkeypatch.setattr(st, "slider", slider)
    left, said = records_until(records)
    assert len(left) == shown
    assert said.startswith(f"{shown} of 4 records shown ({pests} with pests, ")
    assert [str(day) for day in asked[0][:3]] == [DAYS[0], DAYS[2], DAYS[2]]
    assert asked[0][4] == units().date_format


def test_records_of_one_day_need_no_slider(records):
    left, said = records_until(records.take(np.array([0])))
    assert (len(left), said) == (1, "1 of 1 records shown (1 with pests, 0 without).")
    assert records_until(Records.none())[1] == ""
