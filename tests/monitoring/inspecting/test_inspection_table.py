"""Inspections in a season's file: each once, by what was seen, and out again in their order."""

import numpy as np
import pyogrio
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.inspecting import inspection_lots, inspection_table
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.plot.grid import plant_numbers
from tests.monitoring.seasons import BEGINS, a_plot

GRID = a_plot().grid
LABEL = plant_numbers(GRID)
SETTINGS = MonitoringSettings(BEGINS)
MONDAY = np.datetime64(BEGINS)


def kept(db, inspections, batch=(1, "Ann")):
    rows = inspection_table.rows(inspections, GRID, LABEL, SETTINGS, batch)
    return int(inspection_table.store(db, rows).sum())


def one(plant=7, result=FOUND, on=MONDAY, **columns):
    filled = {name: np.array([value]) for name, value in columns.items()}
    return Inspections.of(np.array([plant]), np.array([result]), on, **filled)


def column(db, name):
    return [value for (value,) in db.execute(f"SELECT {name} FROM inspections ORDER BY fid")]  # noqa: S608


def test_a_row_says_what_was_found_where_and_when_as_people_read_it(db):
    kept(db, one(second=30_600.4, count=3.0, who="Ben", notes="leaf"))
    names = "plant, line, number, day, date, time, result, count, who, notes, batch, undone"
    row = db.execute(f"SELECT {names} FROM inspections").fetchone()  # noqa: S608
    place = (7, int(LABEL.line[7]), int(LABEL.number[7]))
    seen = (0, "2026-04-06", "08:30:00", "found", 3.0, "Ben", "leaf", 1, 0)
    assert row == (*place, *seen)


# as the first versions stored them
@pytest.mark.parametrize(
    ("inspection", "digest"),
    [
        (one(second=30_600.0, count=3.0), "c416ebd087c0ac9b9d9f26ea"),
        (one(result=CLEAN), "f229da857d953e2ac380c6ad"),
    ],
)
def test_an_inspection_has_the_digest_that_season_files_hold(db, inspection, digest):
    kept(db, inspection)
    assert column(db, "digest") == [digest]


@pytest.mark.parametrize("again", [one(), one(who="Eve"), one(notes="more")])
def test_who_inspected_and_what_was_noted_make_no_other_inspection(db, again):
    assert (kept(db, one()), kept(db, again)) == (1, 0)


@pytest.mark.parametrize(
    "other",
    [one(plant=8), one(result=CLEAN), one(on=MONDAY + 1), one(second=60.0), one(count=2.0)],
)
def test_any_other_plant_result_date_time_or_count_does(db, other):
    assert (kept(db, one()), kept(db, other)) == (1, 1)


def test_whose_inspections_they_are_is_told_where_they_do_not_say(db):
    kept(db, one(), (1, "Ann"))
    kept(db, one(plant=8, who="Ben"), (1, "Ann"))
    assert column(db, "who") == ["Ann", "Ben"]


def test_they_come_back_by_day_and_time_the_untimed_last_and_as_they_were_recorded(db):
    times = np.array([np.nan, 500.0, np.nan, 400.0, 300.0])
    days = MONDAY + np.array([0, 0, 0, 0, 3])
    kept(db, Inspections.of(np.array([9, 8, 7, 6, 5]), np.zeros(5, int), days, second=times))
    again = inspection_lots.load(db, BEGINS)
    assert again.plant.tolist() == [6, 8, 9, 7, 5]
    assert (again.date - MONDAY).astype(int).tolist() == [0, 0, 0, 0, 3]
    np.testing.assert_array_equal(again.second, [400.0, 500.0, np.nan, np.nan, 300.0])


rows = st.tuples(
    st.integers(0, len(GRID) - 1),
    st.sampled_from((CLEAN, FOUND, SKIPPED)),
    st.integers(0, 20),
    st.none() | st.integers(0, 86_399),
    st.none() | st.integers(0, 500),
    st.text(st.characters(codec="utf-8", exclude_characters="\x00"), max_size=4),
)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(rows, max_size=20, unique_by=lambda row: row[:4]))
def test_whatever_is_recorded_comes_back_as_it_was(db, listed):
    db.execute("DELETE FROM inspections")
    plant, result, day, second, count, notes = zip(*listed, strict=True) if listed else [()] * 6
    told = Inspections.of(
        np.array(plant, int),
        np.array(result, int),
        MONDAY + np.array(day, int),
        second=np.array(second, float),
        count=np.where(np.array(result) == FOUND, np.array(count, float), np.nan),
        notes=np.array(notes, object),
    )
    assert kept(db, told, (1, "")) == len(told)
    again = inspection_lots.load(db, BEGINS)
    order = np.lexsort((np.nan_to_num(told.second, nan=1e9), told.date))
    for name, values in vars(told.take(order)).items():
        assert [str(v) for v in getattr(again, name)] == [str(v) for v in values], name


def test_what_was_undone_or_added_by_other_programs_does_not_count(db):
    kept(db, Inspections.of(np.array([5, 6, 7]), np.zeros(3, int), MONDAY))
    db.execute("UPDATE inspections SET undone = 1 WHERE plant = 5")
    db.execute("UPDATE inspections SET digest = NULL WHERE plant = 6")
    assert inspection_lots.load(db, BEGINS).plant.tolist() == [7]


def test_of_none_recorded_there_are_none(db):
    assert len(inspection_lots.load(db, BEGINS)) == 0


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (one(plant=99_999), "0 to .* from another plot"),
        (one(plant=-1), "from another plot"),
        (one(on=np.datetime64("NaT")), "result 1 has none"),
        (one(count=-2.0), "0 or more, but result 1 says -2.0"),
        (one(result=CLEAN, count=3.0), "Only a find has a count.*result 1 is clean and counts 3"),
        (one(result=SKIPPED, count=1.0), "is skipped and counts 1"),
        (one(second=90_000.0), "within its day"),
    ],
)
def test_what_does_not_fit_is_a_sentence(wrong, says):
    with pytest.raises(ObservationError, match=says):
        inspection_table.rows(wrong, GRID, LABEL, SETTINGS, (1, ""))


def test_dates_outside_the_season_are_a_sentence():
    with pytest.raises(SettingError, match="began on 2026-04-06"):
        inspection_table.rows(one(on=MONDAY - 1), GRID, LABEL, SETTINGS, (1, ""))


def test_rows_that_another_program_adds_do_not_count_before_they_are_recorded(path):
    season = Season(path)
    before = season.evening(BEGINS)
    extra = pyogrio.read_dataframe(path, layer="inspections").tail(1)
    extra[["digest", "batch", "undone", "plant", "day"]] = None
    pyogrio.write_dataframe(extra, path, layer="inspections", append=True)
    assert np.array_equal(season.evening(BEGINS), before)
    assert len(season.history.inspections) == 12


@pytest.mark.parametrize(
    ("columns", "says"),
    [
        ({"second": -5.0}, "A time must lie within its day"),
        ({"count": np.inf}, "A count must be 0 or more"),
    ],
)
def test_no_row_is_made_of_what_cannot_have_been(db, columns, says):
    with pytest.raises(ObservationError, match=says):
        kept(db, one(**columns))
    assert column(db, "plant") == []


def test_the_last_second_of_a_day_is_its_last(db):
    kept(db, one(second=86_399.0))
    kept(db, one(8, second=86_399.9))
    assert column(db, "time") == ["23:59:59", "23:59:59"]
