"""Inspections: columns of one length, unknown where not said, and nobody can change them."""

from datetime import date, datetime, time, timedelta, timezone

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.inspection_columns import COLUMNS
from fieldmon.infestation.inspections import CLEAN, FOUND, RESULT_NAMES, SKIPPED, Inspections
from fieldmon.infestation.records import Records

MONDAY, TUESDAY = np.datetime64("2026-04-06"), np.datetime64("2026-04-07")


def week():
    return Inspections.of(
        np.array([7, 3, 5, 7]),
        np.array([CLEAN, FOUND, SKIPPED, CLEAN]),
        np.array([MONDAY, MONDAY, TUESDAY, TUESDAY]),
        second=np.array([600.0, np.nan, 30.5, 40.0]),
        count=np.array([np.nan, 4.0, np.nan, np.nan]),
        who=np.array(["Ann", "Ann", "Ben", ""]),
        notes=np.array(["", "yellow leaves", "", ""], object),
    )


def test_what_is_not_given_is_unknown():
    one = Inspections.of(np.array([3]), np.array([FOUND]), MONDAY)
    assert np.isnan([one.second[0], one.count[0], one.detects[0]]).all()
    assert (one.who.tolist(), one.notes.tolist()) == ([""], [""])
    assert len(Inspections.none()) == 0
    assert np.isnat(Inspections.of(np.array([3]), np.array([0]), np.datetime64("NaT")).date).all()


@pytest.mark.parametrize("on", [date(2026, 4, 6), MONDAY, np.datetime64("2026-04-06T17:30")])
def test_one_date_is_that_of_all(on):
    two = Inspections.of(np.array([3, 4]), np.array([FOUND, CLEAN]), on)
    assert two.date.tolist() == [date(2026, 4, 6)] * 2


AFTERNOON = datetime(2026, 4, 6, 17, 30)
ABROAD = datetime(2026, 4, 6, 1, 30, tzinfo=timezone(timedelta(hours=3)))


@pytest.mark.parametrize(
    ("on", "second"),
    [
        (AFTERNOON, [63_000.0, 63_000.0]),
        (np.datetime64("2026-04-06T17:30"), [63_000.0, 63_000.0]),
        ([AFTERNOON, date(2026, 4, 6)], [63_000.0, np.nan]),
        (pd.DatetimeIndex(["2026-04-06 17:30:15", "2026-04-06"]), [63_015.0, np.nan]),
        (["2026-04-06T17:30", "2026-04-06"], [63_000.0, np.nan]),
        (MONDAY, [np.nan, np.nan]),
    ],
)
def test_a_time_of_day_is_when_plants_were_inspected(on, second):
    two = Inspections.of([3, 4], [FOUND, CLEAN], on)
    assert two.date.tolist() == [date(2026, 4, 6)] * 2
    np.testing.assert_array_equal(two.second, second)


@pytest.mark.parametrize(
    "on",
    [
        ABROAD,
        pd.Series([ABROAD, ABROAD]),
        pd.DatetimeIndex([ABROAD, ABROAD]),
        "2026-04-06T01:30+03:00",
        np.array(["2026-04-06", "2026-04-05 22:30Z"]),
        pd.Series(["2026-04-06T01-05", None], dtype="string"),
    ],
)
def test_a_time_of_a_zone_is_refused_where_no_plot_is_known(on):
    for asked in (
        lambda: Inspections.of([3, 4], [FOUND, CLEAN], on),
        lambda: Records.of([[35.1, 30.3]] * 2, [1, 0], on),
    ):
        with pytest.raises(ObservationError, match=r"the plot's own, but .*(2026|UTC).* names"):
            asked()


def test_columns_of_more_than_one_line_are_refused_for_their_shape():
    with pytest.raises(ObservationError, match="one an inspection, but they have the shape"):
        Inspections.of([[5, 6]], [FOUND], MONDAY)


def test_a_time_of_day_is_said_once():
    with pytest.raises(ObservationError, match="be said once, but"):
        Inspections.of([3], [FOUND], AFTERNOON, second=[8.0])
    assert Inspections.of([3], [FOUND], MONDAY, second=[8.0]).second.tolist() == [8.0]


def test_columns_have_the_same_types_wherever_they_come_from():
    made = Inspections.of(
        np.array([3], np.int64), np.array([True]), MONDAY, count=np.array([2]), who=np.array(["x"])
    )
    for other in (made, week(), Inspections.none()):
        kinds = [str(getattr(other, name).dtype) for name in vars(week())]
        assert kinds == ["int32", "int8", "datetime64[D]", "float64", "float64", "object", "object",
                         "float64"]  # fmt: skip


@pytest.mark.parametrize(
    "who",
    [
        ["Ann", None],
        np.array(["Ann", np.nan], object),
        pd.Series(["Ann", None]),
        pd.Series(["Ann", None], dtype=object),
        pd.Series(["Ann", pd.NA], dtype="string"),
        pd.Series(["Ann", None], dtype="category"),
        np.array(["Ann", ""]),
    ],
)
def test_missing_texts_are_nothing_whatever_they_stand_in(who):
    places = [[35.1, 30.3]] * 2
    for names in (
        Inspections.of([1, 2], [0, 1], MONDAY, who=who).who,
        Inspections.of([1, 2], [0, 1], MONDAY, notes=who).take([0, 1]).notes,
        Records.of(places, [1, 0], MONDAY, species=who).species,
        Records.of(places, [1, 0], MONDAY, stage=who).stage,
    ):
        assert names.tolist() == ["Ann", ""]
    assert Inspections.of([1, 2], [0, 1], MONDAY, who=[np.nan, np.nan]).who.tolist() == ["", ""]


@pytest.mark.parametrize(
    "who", [[7, 8], np.array([7, 8]), ["Ann", 7], [["Ann"], ["Ben"]], [b"Ann", b"Ben"]]
)
def test_what_is_no_text_is_refused_by_name(who):
    with pytest.raises(ObservationError, match="who of inspections must be texts"):
        Inspections.of([1, 2], [0, 1], MONDAY, who=who)
    with pytest.raises(SettingError, match="species of records must be texts"):
        Records.of([[35.1, 30.3]] * 2, [1, 0], MONDAY, species=who)


def test_columns_of_another_length_are_refused_by_name():
    with pytest.raises(ObservationError, match="4 entries, but count has 2"):
        Inspections(**(vars(week()) | {"count": np.zeros(2)}))


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (
            {"result": pd.array([1, None], dtype="Int64")},
            r"2 \(skipped\), but that of inspection 2 of",
        ),
        ({"result": ["found", "clean"]}, "inspection 1 of 2 is 'found'"),
        ({"result": [1, 300]}, "inspection 2 of 2 is 300"),
        ({"second": [None, time(7, 0)]}, "seconds since local midnight, but that of inspection 2"),
        ({"count": [None, "a"]}, "numbers, but that of inspection 2 of 2 is 'a'"),
        ({"count": [1, [2, 3]]}, "numbers, but that of inspection 2 of 2 is a list"),
    ],
)
def test_of_a_column_that_is_refused_the_first_wrong_value_is_named(wrong, said):
    given = {"plant": [1, 2], "result": [0, 1], "on": MONDAY} | wrong
    with pytest.raises(ObservationError, match=said):
        Inspections.of(**given)


@pytest.mark.parametrize("plant", [2**40, -(2**31) - 1, 1.5])
def test_what_is_no_number_of_a_plant_is_refused_rather_than_cut(plant):
    with pytest.raises(ObservationError, match="plant of inspections must be whole"):
        Inspections.of(np.array([plant]), np.array([CLEAN]), MONDAY)


def test_nobody_can_change_them_and_the_callers_arrays_stay_his_own():
    plants = np.array([3, 4], np.int32)
    made = Inspections.of(plants, np.array([CLEAN, CLEAN]), MONDAY)
    with pytest.raises(ValueError, match="read-only"):
        made.plant[0] = 9
    plants[0] = 8
    assert plants.flags.writeable


def test_a_callers_buffers_that_are_filled_anew_change_no_inspections():
    """A loop over days, with arrays of the very types kept, changed what the days before said."""
    columns = vars(week())
    given = {name: column.copy() for name, column in columns.items()}
    shared = {name: column.view() for name, column in given.items()}
    for column in shared.values():
        column.setflags(write=False)
    made = [
        Inspections(**given),
        Inspections(**shared),
        Inspections.of(given["plant"], given["result"], given["date"]),
    ]
    for column in given.values():
        column[:] = column[::-1].copy()
    for one in made:
        assert one.plant.tolist() == columns["plant"].tolist()
        assert one.result.tolist() == columns["result"].tolist()
        assert one.date.tolist() == columns["date"].tolist()
    assert made[0].notes.tolist() == columns["notes"].tolist()


def test_those_of_a_date_and_those_really_inspected():
    assert week().on(MONDAY).plant.tolist() == week().on(date(2026, 4, 6)).plant.tolist() == [7, 3]
    assert week().on(np.datetime64("2026-05-01")).plant.tolist() == []
    assert week().inspected.plant.tolist() == [7, 3, 7]


@given(st.lists(st.integers(0, 3)))
def test_taking_some_takes_the_same_of_every_column(which):
    some = week().take(np.array(which, np.intp))
    for name, values in vars(week()).items():
        wanted = [values[k] for k in which]
        assert [str(v) for v in getattr(some, name)] == [str(v) for v in wanted]


def test_every_result_has_a_name_of_its_own():
    assert sorted(RESULT_NAMES) == [CLEAN, FOUND, SKIPPED]
    assert len(set(RESULT_NAMES.values())) == 3


@pytest.mark.parametrize("result", [-1, 3, 127])
def test_what_is_no_result_is_refused_where_inspections_are_made(result):
    said = (
        "A result must be 0 (clean), 1 (found) or 2 (skipped), but that of inspection 2 of 2 is "
        f"{result}."
    )
    with pytest.raises(ObservationError) as refused:
        Inspections.of([3, 4], [FOUND, result], MONDAY)
    assert str(refused.value) == said


def test_what_is_no_plant_or_day_at_all_is_refused_in_a_sentence():
    for plant, on, says in ((["a"], MONDAY, "The plant of"), ([1], "6/4", "date .* '6/4'")):
        with pytest.raises(ObservationError, match=says):
            Inspections.of(plant, [FOUND], on)
    assert len(Inspections.of(7, FOUND, MONDAY)) == 1


@pytest.mark.parametrize("which", [[True, False, True], [2, 0], slice(1, None)])
def test_what_is_picked_or_put_together_cannot_be_changed_either(which):
    seen = Inspections.of([3, 4, 5], [0, 1, 2], "2026-11-18", who=["Ann", "", "Bo"])
    for made in (seen.take(which), seen.and_those(seen)):
        assert not any(getattr(made, column.name).flags.writeable for column in COLUMNS)


@pytest.mark.parametrize("detects", [0.0, -0.1, 84.0])
def test_a_chance_to_see_what_is_there_is_above_0_and_1_at_most(detects):
    day = np.datetime64("2026-11-18")
    with pytest.raises(ObservationError, match="must be above 0, and 1 at most"):
        Inspections.of(np.array([3, 4]), np.array([0, 0]), day, detects=[0.3, detects])
