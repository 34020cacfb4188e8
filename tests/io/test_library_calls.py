"""What all calls of the library do with files, options, questions and doubts."""

from types import SimpleNamespace

import pytest

from fieldmon.errors import ChoiceNeeded, ImportDoubt, SettingError
from fieldmon.io.import_report import dropped, seen
from fieldmon.io.library_calls import answered, chosen, must_be_file, warn_of
from fieldmon.io.options import ReadOptions, Upload


@pytest.mark.parametrize("writes", ["to_file", "to_csv", "write_csv"])
def test_who_hands_over_a_frame_is_told_how_it_becomes_a_file(writes):
    with pytest.raises(SettingError, match=rf"Write it to a file first: frame\.{writes}\("):
        must_be_file(SimpleNamespace(**{writes: None}))


def test_a_path_an_upload_and_several_uploads_are_files_and_nothing_else_is():
    part = Upload("a.shp", b"")
    for file in ("estate.zip", part, (part, part)):
        must_be_file(file)
    for none in ((), (part, "a.dbf"), 3):
        with pytest.raises(SettingError, match="A file of rows must be given by its path"):
            must_be_file(none, "A file of rows")


@pytest.mark.parametrize(
    ("asked", "role", "answer"),
    [
        (("crs", ("EPSG:2039",)), "", " Answer with crs='EPSG:2039', for instance."),
        (("columns", ("lon=a", "lon=b")), "", " Answer with columns={'lon': 'a'}, for instance."),
        (("crs", ()), "", " Answer with crs='...', for instance."),
        (("plots", ("one",)), "", " Give the file of the plots first."),
        (("crs", ("EPSG:2039",), "rows"), "plot", ""),
        (("doubles", ("one",), "plants"), "plot", " Answer with doubles='one', for instance."),
    ],
)
def test_a_question_names_the_argument_that_answers_it_or_none(asked, role, answer):
    with pytest.raises(ChoiceNeeded) as said, answered(role):
        raise ChoiceNeeded("Which?", *asked)
    assert str(said.value) == f"Which?{answer}"
    assert (said.value.option, said.value.choices) == asked[:2]


def test_options_of_a_call_are_taken_one_after_the_other():
    assert chosen(ReadOptions(), {"crs": "EPSG:2039", "near": (35.0, 29.0)}) == ReadOptions(
        crs="EPSG:2039", near=(35.0, 29.0)
    )


def test_what_is_only_seen_warns_nobody():
    def called():
        warn_of([seen("Columns are named."), dropped("One record lies elsewhere.")])

    with pytest.warns(ImportDoubt) as said:
        called()
    assert [str(one.message) for one in said] == [str(dropped("One record lies elsewhere."))]
    assert said[0].filename == __file__
