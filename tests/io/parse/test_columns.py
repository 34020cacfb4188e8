"""Columns are known by what people call them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.io.options import ROLES
from fieldmon.io.parse.columns import (
    _SYNONYMS,
    find,
    is_of_rows,
    is_of_writing,
    plain,
    recognised,
)


@pytest.mark.parametrize("role", ROLES)
def test_every_role_is_found_by_each_of_its_names(role):
    for name in _SYNONYMS[role]:
        assert find(role, ["other", name]) == name


@given(st.sampled_from(sorted(ROLES)), st.data())
def test_capitals_units_and_punctuation_do_not_matter(role, data):
    name = data.draw(st.sampled_from(_SYNONYMS[role]))
    for written in (name.upper(), f" {name}_", f"{name} (m)", f"{name} [deg]"):
        assert find(role, [written]) == written


@pytest.mark.parametrize(
    ("name", "bare"),
    [("Décimal_Longitude", "decimallongitude"), ("Höhe (m)", "hohe"), ("(a)", "a"), ("X [m]", "x")],
)
def test_a_plain_name_has_no_accents_capitals_or_units(name, bare):
    assert plain(name) == bare


def test_names_cut_to_ten_letters_by_a_shapefile_are_known():
    assert find("lon", ["decimalLon"]) == "decimalLon"
    assert find("count", ["individual"]) == "individual"
    assert find("lon", ["decimalLo"]) is None


def test_the_likeliest_of_several_is_taken_and_of_equals_the_first():
    assert find("count", ["mites", "count"]) == "count"
    assert find("lat", ["Lat", "LAT"]) == "Lat"


def test_a_column_taken_already_plays_no_second_role():
    assert find("name", ["plot", "title"], frozenset({"plot"})) == "title"
    assert find("name", ["plot"], frozenset({"plot"})) is None


def test_those_that_could_play_some_role_are_recognised():
    assert recognised(["Lon", "colour", "תאריך"]) == {"Lon", "תאריך"}


@pytest.mark.parametrize(
    ("role", "name"),
    [
        *(("count", one) for one in ("Anzahl Milben", "Milben", "Milbenzahl", "Número de ácaros")),
        *(("count", one) for one in ("ácaros", "nombre d'acariens", "acariens", "אקריות", "عدد")),
        *(("count", one) for one in ("מספר האקריות", "عدد الأكاروسات")),
        *(("present", one) for one in ("Befund", "hallazgo", "constat", "ממצאים", "الإصابة")),
    ],
)
def test_finds_and_counts_are_called_by_their_names_in_many_languages(role, name):
    assert find(role, ["crop", name]) == name


@pytest.mark.parametrize(
    "name", ["created_date", "CreationDate", "last_edited_date", "Uploaded on"]
)
def test_when_a_record_was_written_is_no_day_of_the_work(name):
    assert is_of_writing(name)
    for other in ("Inspection date", "Expedition date", "Residue date", "Date next to gate"):
        assert not is_of_writing(other)


def test_rows_are_numbered_under_many_names():
    for name in ("ROW_NUM", "Row No.", "rownumber", "vine row id", "Reihe Nr"):
        assert find("row", [name]) == name
        assert recognised([name]) == {name}
    assert is_of_rows("Row label")
    assert not is_of_rows("row spacing")
    assert not is_of_rows("arrow")
