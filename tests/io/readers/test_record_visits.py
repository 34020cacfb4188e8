"""Records of one visit count once; those of something else count each."""

import pytest

from fieldmon.io.readers.records import records_of
from tests.io.readers.read_records import ANY
from tests.io.tables_of_cells import sentences, table


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
        ({"found": ["yes", "no"], "face": ["a", "b"]}, 2, "Column 'face' names faces of plants"),
        ({"face": [1, 2]}, 2, "each counts for the whole plant"),
        ({"face": ["a", ""]}, 2, "only in 'face': each counts"),
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
