"""1.1 that a spreadsheet made of 1.10 is not taken for plant 1 where anything shows it."""

import pytest

from fieldmon.io.import_report import Severity
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.plot.layout import rectangle
from tests.io.readers.test_inspections import read

LONG = rectangle(6, 12)
SHORT = rectangle(6, 9)


def table(labels, head="vine,found"):
    return "\n".join([head, *(f"{one},no" for one in labels)]) + "\n"


def doubted(text, grid=LONG, options=None):
    said = read(text, options, grid).of(Severity.DOUBTFUL)
    return [one.feature for one in said if "drop a last zero" in one.sentence]


def test_a_row_written_down_in_order_shows_which_labels_lost_a_zero():
    # 1.10 became 1.1: there twice, and the second after 1.9
    text = table(f"1.{n}" for n in [*range(1, 10), 1, 11, 12])
    assert doubted(text) == ["record 1", "record 10"]
    imported = read(text, None, LONG)
    assert imported.value.plant.tolist() == [*range(1, 9), 10, 11]
    said = next(str(one) for one in imported.messages if "drop a last zero" in one.sentence)
    assert "1.1 may be plant 1 or plant 10 of row 1" in said
    assert "two columns, or write 1/1" in said


def test_what_is_doubted_is_taken_where_one_asks():
    text = table(["1.9", "1.1", "1.11"])
    options = InspectionOptions().choose("take_doubtful", "yes")
    assert read(text, options, LONG).value.plant.tolist() == [8, 0, 10]


@pytest.mark.parametrize(
    "labels",
    [
        ["1.9", "1.1"],
        ["2.1", "2.11"],
        ["1.01", "1.02", "1.1"],  # padded: 1.10, not 1.01
        ["3,1", "3,5", "3,1", "3,7"],  # as where decimals have a comma
        [f"{row}.{n}" for row in range(1, 7) for n in (1, 3, 5, 7, 8, 9)],  # one of twelve is 10
    ],
)
def test_each_sign_alone_is_enough(labels):
    assert doubted(table(labels).replace(",no", ";no").replace(",found", ";found"))


@pytest.mark.parametrize(
    "labels",
    [
        ["1.1", "1.10", "1.11"],  # zeros were kept
        ["1.1", "2.3", "4.5"],  # three of any plants
        ["1.1", "1.2", "2.1", "2.2"],
        ["1.1", "1.2", "1.3"] * 2,  # all of them twice
    ],
)
def test_a_file_that_shows_nothing_of_it_is_taken(labels):
    assert not doubted(table(labels))


def test_rows_of_fewer_than_ten_plants_have_no_such_doubt():
    text = table(f"{row}.{n}" for row in range(1, 7) for n in (*range(1, 10), 1))
    assert not doubted(text, SHORT)


def test_positions_and_columns_of_their_own_settle_it():
    lonlat = LONG.lonlat([8, 9, 10])
    labels = zip(["1.9", "1.1", "1.11"], lonlat, strict=True)
    rows = [f"{one},{lon:.9f},{lat:.9f},no" for one, (lon, lat) in labels]
    assert not doubted("\n".join(["vine,lon,lat,found", *rows]))
    assert not doubted("row,vine,found\n1,9,no\n1,1,no\n1,11,no\n")
