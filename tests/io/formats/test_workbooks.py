"""Sheets of new and old workbooks, row by row, whatever they say of their size."""

import io
import zipfile

import openpyxl
import pytest

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.workbooks import sheet_names, sheet_rows
from fieldmon.io.sandbox import limits
from tests.awkward_real_files import ods
from tests.old_workbook import xls

CELLS = [["name", "n", "when"], ["north", 2.5, None], [None, None, None], ["south", None, "x"]]


def new(path):
    book = openpyxl.Workbook()
    book.active.title = "Sheet1"
    for row in CELLS:
        book.active.append(row)
    book.create_chartsheet("drawing")
    book.save(path)


MAKE = {
    ".xlsx": new,
    ".xls": lambda path: path.write_bytes(xls(CELLS)),
    ".ods": lambda path: path.write_bytes(ods([[v or "" for v in row] for row in CELLS])),
}


@pytest.fixture(params=MAKE)
def path(request, tmp_path):
    MAKE[request.param](tmp_path / f"book{request.param}")
    return tmp_path / f"book{request.param}"


def test_all_workbooks_hold_the_same_cells(path):
    assert sheet_names(path, "b") == ("Sheet1",)
    assert sheet_rows(path, "b", "Sheet1") == [
        ["name", "n", "when"],
        ["north", 2.5],
        [],
        ["south", None, "x"],
    ]


def test_a_spreadsheet_with_lines_between_its_cells_is_read_as_gdal_writes_it(tmp_path):
    """And its texts stay as they are: calamine stops at what stands between cells."""
    packed = io.BytesIO(ods([["plot", "note"], ["north", "a  <text:s/> b"]]))
    with zipfile.ZipFile(packed) as book:
        parts = {one: book.read(one) for one in book.namelist()}
    with zipfile.ZipFile(path := tmp_path / "book.ods", "w") as book:
        for one, content in parts.items():
            book.writestr(one, content.replace(b"><", b">\n<"))
    assert sheet_names(path, "b") == ("Sheet1",)
    assert sheet_rows(path, "b", "Sheet1") == [["plot", "note"], ["north", "a    b"]]


def test_a_sheet_that_there_is_not_is_a_question(path):
    with pytest.raises(ChoiceNeeded, match="no sheet 'rows'") as asked:
        sheet_rows(path, "b", "rows")
    assert (asked.value.option, asked.value.choices) == ("layer", ("Sheet1",))


def test_what_breaks_off_is_refused(path):
    path.write_bytes(path.read_bytes()[:300])
    with pytest.raises(FileProblem, match="must be a workbook of Excel or LibreOffice"):
        sheet_names(path, "b")


def test_a_row_too_many_is_noticed_by_the_table(path, monkeypatch):
    monkeypatch.setattr(limits, "RECORDS", 1)
    assert len(sheet_rows(path, "b", "Sheet1")) == 2
