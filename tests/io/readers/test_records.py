"""Records out of a table: where, when, how many, whether at all, and what is doubted."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.errors import ChoiceNeeded, ObservationError
from fieldmon.infestation.observations import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.import_report import Severity
from fieldmon.io.options import RecordOptions
from fieldmon.io.readers.places import NamedPlaces, Plants
from fieldmon.io.readers.records import records_by_plot, records_of
from fieldmon.plot.field import Field
from tests.io.tables_of_cells import sentences, table

ANY = RecordOptions()


def at(n, **columns):
    """Return a table of so many records, each at a place of its own."""
    return table(lon=[35.150123 + k / 1e4 for k in range(n)], lat=[30.360789] * n, **columns)


def read(options=ANY, **columns):
    n = len(next(iter(columns.values())))
    return records_of(at(n, **columns), options)


def vines(lon):
    """Return two plants, 1 and 2, of row 1."""
    return Plants(
        np.array([[lon, 45.0], [lon, 45.001]]), np.array(["1", "1"]), np.array(["1", "2"])
    )


def said(imported, severity):
    return "\n".join(message.sentence for message in imported.of(severity))


def test_zero_is_absent_and_nothing_is_not_known():
    records = read(count=[3, 0, None, "0", "n/a", ""]).value
    assert records.present.tolist() == [PRESENT, ABSENT, UNKNOWN, ABSENT, UNKNOWN, UNKNOWN]
    np.testing.assert_array_equal(records.count, [3, 0, np.nan, 0, np.nan, np.nan])


def test_a_word_says_whether_where_no_count_does():
    records = read(present=["yes", "no", "", "maybe"])
    assert records.value.present.tolist() == [PRESENT, ABSENT, UNKNOWN, UNKNOWN]
    assert "neither yes nor no: 'maybe'" in said(records, Severity.DOUBTFUL)


def test_all_words_that_say_neither_are_asked_about_at_once_and_those_said_before_stay():
    cells = ["yes", "perhaps", "krobbig", "a, b", "no"]
    (odd,) = [one for one in read(present=cells).messages if one.remedy is not None]
    assert odd.remedy.setting == r'"found=a\, b,krobbig,perhaps"'
    told = read(RecordOptions(found="krobbig"), present=cells)
    assert told.value.present.tolist() == [PRESENT, UNKNOWN, PRESENT, UNKNOWN, ABSENT]
    (odd,) = [one for one in told.messages if one.remedy is not None]
    assert odd.remedy.setting == r'"found=krobbig,a\, b,perhaps"'
    told = read(RecordOptions(found=odd.remedy.value), present=cells)
    assert told.value.present.tolist() == [PRESENT, PRESENT, PRESENT, PRESENT, ABSENT]


def test_nothing_of_a_leaf_is_clean_and_any_part_of_it_a_find():
    records = read(severity=["0%", "30 %", "0,0 %", "100%", ""])
    assert records.value.present.tolist() == [ABSENT, PRESENT, ABSENT, PRESENT, UNKNOWN]
    assert np.isnan(records.value.count).all()
    assert "neither" not in said(records, Severity.DOUBTFUL)
    assert "no plain number ('30%')" in said(read(count=["30%", "2"]), Severity.DOUBTFUL)


def test_waypoints_say_in_their_names_what_was_found_where_nothing_else_does():
    records = read(name=["+3", "-", "0", "clean", "R3/17 +", "007"])
    assert records.value.present.tolist() == [PRESENT, ABSENT, ABSENT, ABSENT, PRESENT, UNKNOWN]
    np.testing.assert_array_equal(records.value.count, [3, *[np.nan] * 5])
    (guess,) = [one for one in records.of(Severity.GUESSED) if one.feature == "name"]
    assert (guess.remedy.option, guess.remedy.value) == ("columns", "present=")
    every = read(ANY.choose("columns", "present="), name=["+3", "-", "0", "clean"])
    assert every.value.present.tolist() == [PRESENT] * 4
    # of others a word here and there says nothing
    with pytest.raises(ChoiceNeeded) as asked:
        read(name=["gate", "shed", "x", "tank"])
    assert "present=name" not in asked.value.choices


def test_a_word_that_contradicts_its_count_is_doubted_and_believed():
    records = read(count=[3, 0, 2], present=["yes", "yes", None])
    assert records.value.present.tolist() == [PRESENT, PRESENT, PRESENT]
    assert "1 record contradicts its own count" in said(records, Severity.DOUBTFUL)


def test_a_file_that_only_lists_places_asks_what_was_found_and_offers_what_could_be_a_count():
    with pytest.raises(ChoiceNeeded, match="says what was found") as asked:
        read(zz=[1, 2, 3], crop=["a", "b", "c"])
    counted, all_finds = asked.value.choices
    assert (counted, all_finds) == ("count=zz", "present=")
    again = records_of(at(3, zz=[1, 0, 3]), ANY.choose("columns", counted))
    assert again.value.present.tolist() == [PRESENT, ABSENT, PRESENT]
    again = records_of(at(3, zz=[1, 0, 3]), ANY.choose("columns", all_finds))
    assert (again.value.present == PRESENT).all()


DETECTED = {"class": ["mite", "background", "mite"], "confidence": [0.54, 0.83, 0.78]}


def test_what_a_robot_saw_is_asked_for_in_words_that_answer_and_never_taken_from_its_confidence():
    with pytest.raises(ChoiceNeeded) as asked:
        read(**DETECTED)
    assert asked.value.choices == ("present=class", "present=")
    for role in ("present", "found", "result"):
        imported = read(RecordOptions(columns=((role, "class"),)), **DETECTED)
        assert imported.value.present.tolist() == [PRESENT, ABSENT, PRESENT]
        unused = [one.feature for one in imported.messages if "is not used" in one.sentence]
        assert unused == ["confidence"]
    told = read(ANY.naming(count="confidence"), **DETECTED)
    assert "as confidences are" in said(told, Severity.DOUBTFUL)
    assert "is not used" not in said(told, Severity.SEEN)
    assert "as confidences" not in said(read(mites=[0.5, 0.1, 0]), Severity.DOUBTFUL)


def test_a_count_that_is_no_plain_number_is_read_roughly_and_shown():
    records = read(count=["3", "~10", ">5", "many"])
    assert "no plain number" in said(records, Severity.DOUBTFUL)
    assert (records.value.present[:3] == PRESENT).all()


def test_a_number_that_nobody_counts_is_left_open_and_shown():
    records = read(count=["3", "1e308", "0"])
    assert "1 count says neither how many nor whether any ('1e308')" in said(
        records, Severity.DOUBTFUL
    )
    assert records.value.present.tolist() == [PRESENT, UNKNOWN, ABSENT]
    assert np.isnan(records.value.count[1])


def test_a_comma_is_what_the_rest_of_the_table_says_it_is_and_else_a_guess():
    np.testing.assert_allclose(read(count=["1,5", "1,234"]).value.count, [1.5, 1.234])
    assert read(count=["1,234", "7"]).value.count.tolist() == [1234.0, 7.0]  # as in 35.150123
    half = read(count=["0,500", "7"])
    assert half.value.count.tolist() == [0.5, 7.0]  # no thousands begin so
    both = read(count=["2,5", "1,234", "3.000"])
    assert both.value.count.tolist() == [2.5, 1.234, 3000.0]
    assert "Counts such as 3.000 were read as thousands" in said(both, Severity.GUESSED)
    average = RecordOptions(columns=(("count", "average"),))
    assert read(average, average=["1.250", "2.333"]).value.count.tolist() == [1.25, 2.333]
    layer, places = table(plant=["1", "2"], count=["1,234", "7"]), NamedPlaces(plants=vines(5.0))
    alone = records_of(layer, ANY, places)
    assert alone.value.count.tolist() == [1234.0, 7.0]
    (guess,) = [m for m in alone.of(Severity.GUESSED) if "thousands" in m.sentence]
    options = ANY.choose(guess.remedy.option, guess.remedy.value)
    assert records_of(layer, options, places).value.count.tolist() == [1.234, 7.0]


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


@pytest.mark.parametrize(
    ("time", "found", "north", "kept", "words"),
    [
        ("2026-11-16T08:00:00Z", 1, 0.0, 1, "one visit, which counts once"),
        ("2026-11-16T10:09:00+02:00", 1, 0.0, 1, "1 record repeats what another says"),
        ("2026-11-16T13:00:00Z", 1, 0.0, 2, "another time: each visit counts"),
        ("2026-11-17T08:00:00Z", 1, 0.0, 2, ""),
        ("2026-11-16T08:00:00Z", 0, 0.0, 2, "gives another count"),
        ("2026-11-16T08:00:00Z", 1, 1e-5, 2, ""),
    ],
)
def test_a_plant_of_which_a_robot_tells_often_in_one_visit_counts_once(
    time, found, north, kept, words
):
    imported = records_of(
        table(
            lon=[35.150123] * 2, lat=[30.360789, 30.360789 + north], found=[1, found],
            time=["2026-11-16T08:00:00Z", time], detection_id=[1, 2],
        ),
        ANY,
    )  # fmt: skip
    assert len(imported.value) == kept
    told = " ".join(message.sentence for message in imported.messages)
    assert words in told
    assert ("visit" in told) == ("visit" in words or "repeats" in words)


@pytest.mark.parametrize(
    ("columns", "kept", "words"),
    [
        ({}, 1, "one visit, which counts once"),
        ({"scout": ["Ann", "Ben"]}, 2, "the same place and time only in 'scout': each counts"),
        ({"hour": [8, 17]}, 2, "at another time: each visit counts"),
        ({"time": ["early", "late"]}, 2, "2 times are none ('early', 'late')"),
        ({"time": ["08:00", ""]}, 1, "one visit, which counts once"),
        ({"accuracy": [1.5, 1.5]}, 2, ""),
        ({"found": ["yes", "no"]}, 2, "1 record gives another count"),
    ],
)
def test_what_a_file_says_of_something_else_or_of_no_known_plant_is_no_visit_again(
    columns, kept, words
):
    each = {"id": [1, 2], "date": ["2026-11-20"] * 2, "found": ["yes"] * 2} | columns
    layer = table(lon=[35.150123, 35.15012303], lat=[30.360789] * 2, **each)
    imported = records_of(layer, ANY, apart_m=3.0)
    assert len(imported.value) == kept
    assert words in sentences(imported)


def test_positions_rounded_to_half_the_way_to_the_next_plant_tell_no_plants_apart():
    layer = table(
        id=[1, 2], lon=[35.15012] * 2, lat=[30.36079] * 2, date=["2026-11-20"] * 2, found=[1, 1]
    )
    assert len(records_of(layer, ANY, apart_m=3.0).value) == 1
    assert len(records_of(layer, ANY, apart_m=1.0).value) == 2


def test_results_that_could_be_confidences_are_doubted():
    for name in ("detection", "result"):
        records = read(**{name: [0.0, 0.03, 0.08]})
        assert "as confidences are" in said(records, Severity.DOUBTFUL)
    assert "confidences" not in sentences(read(result=[0, 1, "yes"]))


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


def test_what_is_no_count_is_not_said_to_be_read_roughly():
    records = read(count=["<5", "5+", "TNTC", "-3", "4"])
    assert records.value.present.tolist() == [PRESENT, PRESENT, UNKNOWN, UNKNOWN, PRESENT]
    doubts = said(records, Severity.DOUBTFUL)
    assert "2 counts say neither how many nor whether any ('TNTC', '-3'); left open." in doubts
    assert "2 counts are no plain number ('<5', '5+'); read roughly." in doubts


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


def test_dates_in_both_orders_are_doubted_with_how_many_could_be_either():
    records = read(
        count=[1, 1, 1, 1], date=["18/11/2026", "11/15/2026", "11/06/2026", "2026-11-01"]
    )
    assert "1 that could be either were read day first" in said(records, Severity.DOUBTFUL)
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
