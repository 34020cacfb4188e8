"""Records out of a table: where, when, how many, whether at all, and what is doubted."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.errors import ChoiceNeeded, ObservationError
from fieldmon.io.import_report import Severity
from fieldmon.io.options import RecordOptions
from fieldmon.io.readers.places import NamedPlaces
from fieldmon.io.readers.records import records_by_plot, records_of
from fieldmon.plot.field import Field
from tests.io.readers.read_records import ANY, at, read, said, vines
from tests.io.tables_of_cells import sentences, table


def test_days_that_could_be_either_are_read_day_first_with_a_way_out():
    cells = ["03/04/2026", "05/06/2026"]
    records = read(count=[1, 1], date=cells)
    assert records.value.day.astype(str).tolist() == ["2026-04-03", "2026-06-05"]
    (guess,) = records.of(Severity.GUESSED)
    options = ANY.choose(guess.remedy.option, guess.remedy.value)
    assert read(options, count=[1, 1], date=cells).value.day.astype(str).tolist() == [
        "2026-03-04", "2026-05-06",
    ]  # fmt: skip


def test_a_day_in_three_columns_is_put_together():
    records = read(count=[1, 1], year=[2026, 2026], month=[4, 13], day=[7, 7]).value
    assert records.day[0] == np.datetime64("2026-04-07")
    assert np.isnat(records.day[1])


def test_days_that_are_none_stay_open_and_those_to_come_are_doubted():
    ahead = (datetime.now(UTC) + timedelta(days=40)).date().isoformat()
    records = read(count=[1, 1, 1], date=["2026-04-01", "soon", ahead])
    assert np.isnat(records.value.day).tolist() == [False, True, False]
    doubts = said(records, Severity.DOUBTFUL)
    assert (
        "1 record has a date that is none (record 2: 'soon'). It counts as 14 days old, " in doubts
    )
    assert f"1 record lies in the future, the last on {ahead}" in doubts


def test_a_file_without_days_says_so_and_offers_a_column_that_holds_some():
    records = read(count=[1, 2], when_seen=["2026-04-01", "2026-04-02"])
    (doubt,) = [m for m in records.messages if "No column was recognised" in m.sentence]
    assert np.isnat(records.value.day).all()
    assert doubt.remedy.choices == ("date=when_seen",)


def test_records_that_repeat_another_in_every_column_are_left_out():
    layer = table(lon=[35.150123] * 3, lat=[30.360789] * 3, count=[1, 1, 2])
    records = records_of(layer, ANY)
    assert records.value.count.tolist() == [1.0, 2.0]
    assert "1 record repeats another" in said(records, Severity.DROPPED)
    assert "another count for a place and day" in said(records, Severity.DOUBTFUL)


def test_several_species_are_asked_about_and_each_can_be_chosen_alone():
    several = {"count": [1, 2, 3], "species": ["mite", "aphid", "mite"]}
    with pytest.raises(ChoiceNeeded, match="names 2: aphid, mite") as asked:
        read(**several)
    assert (asked.value.option, asked.value.choices) == ("where", ("species=aphid", "species=mite"))
    as_one = read(**several, options=RecordOptions(columns=(("species", ""),)))
    assert as_one.value.species.tolist() == [""] * 3
    assert read(count=[1, 2], species=["mite", ""]).value.species.tolist() == ["mite", ""]
    one = read(count=[1, 2, 3], species=["mite", "Mite", "mite"])
    assert "Mite and mite were taken for one pest" in sentences(one)
    assert one.value.species.tolist() == ["mite"] * 3
    visits = read(count=[1, 2], Art=["Kontrolle", "Nachkontrolle"])
    assert visits.value.species.tolist() == ["", ""]


def test_what_else_a_record_knows_comes_with_it():
    columns = {
        "count": [1, 2],
        "accuracy": [4, -1],
        "stage": ["adult", "n/a"],
        "leaves": [10, None],
    }
    records = read(**columns).value
    np.testing.assert_array_equal(records.accuracy_m, [4, np.nan])
    assert records.stage.tolist() == ["adult", ""]
    np.testing.assert_array_equal(records.leaves_sampled, [10, np.nan])


def test_accuracies_are_read_with_their_units():
    records = read(count=[1, 2, 3], accuracy=["25 m", "10 ft", "poor"])
    assert records.value.accuracy_m == pytest.approx([25.0, 3.048, np.nan], nan_ok=True)
    assert "3, 3 m or 10 ft, but 1 is not: 'poor'" in sentences(records)


def test_an_empty_table_is_refused():
    with pytest.raises(ObservationError, match="must hold records, but it holds none"):
        records_of(table(lon=[], lat=[], count=[]), ANY)


def test_records_that_name_their_plots_are_told_apart_by_plot():
    fields = tuple(
        Field(name, MultiPolygon([box(lon - 0.01, 44.99, lon + 0.01, 45.01)]))
        for name, lon in (("North", 5.0), ("South", 5.1))
    )
    places = NamedPlaces(fields, plants_of={"North": vines(5.0), "South": vines(5.1)})
    layer = table(plot=["South", "North", "South"], row=[1, 1, 1], plant=[1, 1, 1], count=[1, 2, 3])
    by_plot = records_by_plot(layer, ANY, places).value
    assert {name: part.count.tolist() for name, part in by_plot.items()} == {
        "North": [2.0], "South": [1.0, 3.0],
    }  # fmt: skip
    assert set(by_plot["South"].lonlat[:, 0]) == {5.1}
    assert records_by_plot(at(1, count=[1]), ANY, places).value == {}


def test_midnights_that_are_most_of_the_times_are_days_and_that_is_told_once():
    times = ["2026-11-18 00:00:00", "2026-11-19 00:00:00", "2026-11-19 09:30:00"]
    told = said(read(count=[1, 1, 1], date=times), Severity.GUESSED)
    assert told.count("2 dates with the time 00:00 among others were read as days") == 1
    # the same place and day: a day alone is no other visit
    same = table(
        lon=[35.150123] * 3, lat=[30.360789] * 3, found=[1] * 3, detection_id=[1, 2, 3],
        date=[times[0], times[0], times[2].replace("19", "18")],
    )  # fmt: skip
    assert len(records_of(same, ANY).value) == 1


def test_dates_in_both_orders_are_asked_about_and_of_one_order_not():
    both = ["18/11/2026", "11/15/2026", "11/06/2026", "2026-11-01"]
    with pytest.raises(ChoiceNeeded, match="1 could be either"):
        read(count=[1, 1, 1, 1], date=both)
    records = read(count=[1, 1, 1], date=["18/11/2026", "11/06/2026", "2026-11-01"])
    assert said(records, Severity.DOUBTFUL) == ""


@pytest.mark.parametrize(
    ("lon", "time", "day"),
    [
        (35.15, "2026-11-17T23:30:00Z", "2026-11-18"),
        (35.15, "2026-11-17 21:30:00+00:00", "2026-11-17"),
        (35.15, "2026-11-18T01:30:00+02:00", "2026-11-18"),
        (-119.8, "2026-11-19T01:30:00Z", "2026-11-18"),
        (-119.8, "2026-11-18T17:30:00", "2026-11-18"),
        (-119.8, "2026-11-18", "2026-11-18"),
        (-119.8, "2026-11-18T00:00:00Z", "2026-11-18"),
    ],
)
def test_a_record_is_of_the_day_that_its_place_had_whatever_zone_its_time_names(lon, time, day):
    layer = table(lon=[lon], lat=[36.7 if lon < 0 else 30.36], count=[2], date=[time])
    assert records_of(layer, ANY).value.day.astype(str).tolist() == [day]
