"""Texts that come with the program are found, and a table's remarks are no rows."""

import pytest

from fieldmon.io import packaged
from fieldmon.io.packaged import packaged_names, packaged_table, packaged_text, pest_names


def test_a_text_is_that_of_the_file():
    text = packaged_text("fieldmon/io/templates/page.css")
    assert "color-scheme" in text


def test_a_text_that_is_not_there_is_an_error():
    with pytest.raises(FileNotFoundError):
        packaged_text("fieldmon/io/templates/none.css")


def test_remarks_are_no_rows_and_quoted_commas_no_columns(monkeypatch):
    text = '# from: a book, table 2\n# more\na,b\n1,"x, # y"\n2,\n'
    monkeypatch.setattr(packaged, "packaged_text", lambda _: text)
    assert packaged_table("any") == [{"a": "1", "b": "x, # y"}, {"a": "2", "b": ""}]


def test_files_of_a_folder_are_found_by_their_ending():
    assert packaged_names("fieldmon/decisions", ".csv") == ["thresholds.csv"]


def test_pests_are_named_by_their_files_the_thesis_first():
    names = pest_names()
    assert names[:2] == ("thesis", "spider-mite")
    assert {f"{name}.toml" for name in names} == set(packaged_names(packaged.PESTS, ".toml"))
