"""Counts in several columns: one is read, and what stands in the others is not passed over."""

import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.infestation.records import ABSENT, PRESENT
from fieldmon.io.import_report import Severity
from fieldmon.io.options import RecordOptions
from fieldmon.io.readers.inspection_file.rows import rows_in
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.other_counts import counts_pests
from fieldmon.io.readers.records import records_of
from tests.io.tables_of_cells import table

PLACES = {"lon": [35.150123, 35.150223], "lat": [30.360789] * 2}


def records(cells, **said):
    return records_of(table(**PLACES, **cells), RecordOptions(**said))


def inspections(cells, **said):
    return rows_in(table(row=[3, 3], number=[7, 8], **cells), InspectionOptions(**said))


def doubts(imported):
    told = (one for one in imported.messages if one.severity == Severity.DOUBTFUL)
    return [one for one in told if "count pests" in one.sentence]


@pytest.mark.parametrize("read", [records, inspections])
@pytest.mark.parametrize(
    ("taken", "other"),
    [
        ("adults", "eggs"), ("adults", "nymphs"), ("females", "males"), ("count", "count2"),
        ("total", "mites"), ("mites", "mites_upper"), ("Anzahl", "Eier"), ("conteo", "huevos"),
        ("כמות", "ביצים"), ("mites", "motile stages"),
    ],
)  # fmt: skip
def test_a_plant_is_not_clean_while_another_column_counts_pests_there(read, taken, other):
    with pytest.raises(ChoiceNeeded, match=f"'{other}'") as asked:
        read({other: [12, 0], taken: [0, 1]})
    assert asked.value.option == "columns"
    assert set(asked.value.choices) == {f"count={taken}", f"count={other}"}


@pytest.mark.parametrize("read", [records, inspections])
def test_a_column_of_counts_that_is_not_read_is_named_with_how_to_read_it(read):
    (doubt,) = doubts(read({"eggs": [12, 0], "adults": [3, 0]}))
    assert (doubt.feature, doubt.remedy.value) == ("eggs", "count=eggs")
    assert "'adults'" in doubt.sentence


@pytest.mark.parametrize("read", [records, inspections])
@pytest.mark.parametrize(
    "columns",
    [
        {"eggs": [0, 0], "adults": [0, 3]},
        {"eggs": ["", "n/a"], "adults": [0, 3]},
        {"individualCount": [0, 3], "organismQuantity": [0, 3]},
        {"total": [0, 5], "eggs": [0, 3], "adults": [0, 2]},
        {"adults": [0, 3], "predatory mites": [4, 4], "leaf count": [9, 9], "mite id": [7, 8]},
        {"adults": [0, 3], "pest": [1, 2], "mites seen at": ["8:00", "9:00"]},
    ],
)
def test_nothing_is_said_of_columns_that_add_nothing(read, columns):
    assert not doubts(read(columns))


def test_of_the_column_chosen_a_record_is_clean_and_an_inspection_doubtful():
    columns = {"eggs": [12, 0], "adults": [0, 1]}
    chosen = (("count", "adults"),)
    read = records(columns, columns=chosen)
    assert read.value.present.tolist() == [ABSENT, PRESENT]
    assert [one.feature for one in doubts(read)] == ["eggs"]
    rows = inspections(columns, columns=chosen).value
    assert rows.doubt[1] == ""
    assert "'eggs'" in rows.doubt[0]


@pytest.mark.parametrize("read", [records, inspections])
def test_results_in_a_column_of_their_own_drop_no_counts_silently(read):
    told = {"columns": (("present", "zz"),)}
    (doubt,) = doubts(read({"zz": ["yes", "no"], "eggs": [4, 0]}, **told))
    assert doubt.remedy.value == "count=eggs"
    with pytest.raises(ChoiceNeeded, match="'eggs'"):
        read({"zz": ["no", "yes"], "eggs": [4, 0]}, **told)


@pytest.mark.parametrize(
    ("name", "does"),
    [
        *((one, True) for one in ("nEggs", "egg_count", "Larven", "Milben oben", "count_left")),
        *((one, True) for one in ("total", "œufs", "acariens 2", "בוגרים", "بيض", "MitesUpper")),
        *((one, False) for one in ("photo count", "total_area", "pest_id", "male tree", "leaves")),
        *((one, False) for one in ("mite confidence", "eggs_date", "stage", "row", "Species")),
    ],
)
def test_which_columns_count_pests_by_their_names(name, does):
    assert counts_pests(name) == does


@pytest.mark.parametrize("read", [records, inspections])
def test_a_german_sheet_is_read_with_its_finds_and_its_counts(read):
    value = read({"Anzahl Milben": [4, 0], "Befund": ["ja", "nein"]}).value
    assert value.count.tolist() == [4, 0]
