"""What can be chosen about a file: checked when it is said, and set from text alike everywhere."""

from dataclasses import fields

import pytest

from fieldmon.errors import SettingError
from fieldmon.io.options import ROLES, PlotOptions, ReadOptions, RecordOptions, Upload, source_name


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"columns": (("height", "h"),)}, "but not for 'height'"),
        ({"where": "crop"}, "column=value, but it is 'crop'"),
        ({"decimal": ";"}, r"must be \. or , but it is ';'"),
        ({"delimiter": "ab"}, "one character, but it is 'ab'"),
        ({"near": (200.0, 30.0)}, "longitude in -180..180"),
        ({"near": (float("nan"), 30.0)}, "longitude in -180..180"),
    ],
)
def test_an_impossible_option_is_refused_with_what_it_is(options, words):
    with pytest.raises(SettingError, match=words):
        ReadOptions(**options)


def test_an_order_of_dates_is_one_of_three():
    assert {RecordOptions(date_order=o).date_order for o in ("dmy", "mdy", "ymd")} == {
        "dmy", "mdy", "ymd",
    }  # fmt: skip
    with pytest.raises(SettingError, match="dmy, mdy or ymd, but it is 'ydm'"):
        RecordOptions(date_order="ydm")


TEXT_OF = {
    "columns": ("lon=East", (("lon", "East"),)),
    "near": ("35.1, 30.2", (35.1, 30.2)),
    "swap_axes": ("yes", True),
    "outline": ("yes", True),
    "where": ("crop=vine", "crop=vine"),
    "decimal": (",", ","),
    "delimiter": (";", ";"),
    "date_order": ("mdy", "mdy"),
    "header": ("no", "no"),
    "degrees": ("dms", "dms"),
    "doubles": ("one", "one"),
    "far": ("keep", "keep"),
    "place": ("plant", "plant"),
}


@pytest.mark.parametrize("kind", [ReadOptions, PlotOptions, RecordOptions])
def test_every_option_can_be_set_from_text(kind):
    for name in (field.name for field in fields(kind)):
        text, value = TEXT_OF.get(name, ("x", "x"))
        made = kind().choose(name, text)
        assert getattr(made, name) == value
        assert made != kind()
        unset = {f.name for f in fields(kind)} - {name}
        assert all(getattr(made, other) == getattr(kind(), other) for other in unset)


@pytest.mark.parametrize(
    ("text", "value"),
    [("yes", True), ("TRUE", True), ("1", True), ("On", True), ("no", False), ("off", False)],
)
def test_a_switch_is_on_only_where_it_is_said(text, value):
    assert ReadOptions().choose("swap_axes", text).swap_axes is value
    assert ReadOptions().choose("header", text).header == ("yes" if value else "no")


def test_what_is_set_from_text_is_checked_as_any_other():
    for option, text, words in (
        ("decimal", "x", "decimal mark"),
        ("swap_axes", "ja", "yes or no, but it is 'ja'"),
        ("near", "35.1", "must be written lon,lat"),
        ("near", "35.1;30.2", "must be written lon,lat"),
        ("columns", "height=h", "but not for 'height'"),
        ("colour", "red", "no option 'colour'"),
    ):
        with pytest.raises(SettingError, match=words):
            ReadOptions().choose(option, text)


def test_a_column_named_twice_is_the_one_named_last_and_others_stay():
    options = ReadOptions().naming(lon="a", lat="b").naming(lon="c")
    assert (options.column("lon"), options.column("lat"), options.column("date")) == (
        "c",
        "b",
        None,
    )
    assert options.naming(plot="").column("plot") == "", "no column names a plot"
    assert set(ROLES) > {"lon", "lat", "plot", "row", "plant"}


def test_sources_are_called_as_people_know_them(tmp_path):
    uploads = tuple(Upload(f"p.{end}", b"") for end in ("shp", "shx", "dbf", "prj"))
    assert source_name(uploads[0]) == "p.shp"
    assert source_name(uploads[:2]) == "p.shp, p.shx"
    assert source_name(uploads) == "p.shp, p.shx, p.dbf, ..."
    assert source_name(tmp_path / "estate.zip") == "estate.zip"
    assert source_name("folder/estate.zip") == "estate.zip"
