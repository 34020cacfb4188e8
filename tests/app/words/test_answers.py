"""An answer about a file is said in a grower's words, not in a command's."""

from app.words.answers import in_short


def test_no_answer_about_a_column_is_said_as_it_is_handed_back():
    assert in_short("present=", "columns") == "Every record is a find"
    assert in_short("count=Mites", "columns") == "\u2068Mites\u2069: how many were found"
    assert in_short("lon=East", "columns") == "East"
    assert in_short("marker=polygon", "where") == "marker: polygon"
    assert in_short("yes", "outline") == "Take them as the outline"


def test_other_answers_stay_as_they_are():
    assert in_short("EPSG:2039", "crs") == "EPSG:2039"
    assert in_short("Easting", "columns") == "Easting"
