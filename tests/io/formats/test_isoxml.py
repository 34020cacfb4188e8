"""Partfields of ISO 11783-10: rings closed by their type, holes, other files, guidance lines."""

import pytest
import shapely

from fieldmon.errors import FileProblem
from fieldmon.io.formats.isoxml import read_isoxml
from tests.awkward_real_files import _TASKS, GUIDE, POND, SECOND, SQUARE, lsg, pfd, pln
from tests.io.tables_of_cells import sentences


def read(folder, *partfields, **others):
    (folder / "TASKDATA.XML").write_text(_TASKS.format(body="".join(partfields)), encoding="utf-8")
    for name, content in others.items():
        (folder / f"{name}.XML").write_text(f"<XFC>{content}</XFC>", encoding="utf-8")
    return read_isoxml(folder / "TASKDATA.XML", "tasks")


def test_a_partfield_is_its_outline_without_its_holes_in_degrees(tmp_path):
    layer = read(tmp_path, pfd(1, "North", pln(1, SQUARE, POND)))
    assert layer.geometry[0].equals(shapely.difference(SQUARE, POND))
    assert layer.crs == "OGC:CRS84"
    assert layer.columns["name"].tolist() == ["North"]
    assert layer.messages == ()


def test_outer_rings_in_one_polygon_each_keep_their_own_holes(tmp_path):
    rings = pln(1, SQUARE, POND).replace("</PLN>", "") + pln(1, SECOND).partition(">")[2]
    (area,) = read(tmp_path, pfd(1, "x", rings)).geometry
    assert area.equals(shapely.union(shapely.difference(SQUARE, POND), SECOND))


def test_guidance_lines_are_lines_and_other_areas_are_counted(tmp_path):
    pattern = f'<GGP A="GGP1"><GPN A="GPN1">{lsg(5, GUIDE)}</GPN></GGP>'
    layer = read(tmp_path, pfd(1, "x", pln(1, SQUARE), pln(3, POND), pattern))
    assert layer.columns["kind"].tolist() == ["partfield", "guidance line"]
    assert shapely.get_coordinates(layer.geometry[1]).tolist() == [list(p) for p in GUIDE]
    assert "water surface (1)" in sentences(layer)


def test_partfields_may_be_in_a_file_that_is_led_to(tmp_path):
    one = pfd(1, "here", pln(1, SQUARE))
    led = '<XFR A="PFD00001" B="1"/><XFR A="PFD00002" B="1"/>'
    layer = read(tmp_path, one, led, PFD00001=pfd(2, "there", pln(1, SECOND)))
    assert layer.columns["name"].tolist() == ["here", "there"]
    assert "PFD00002.XML, which is not beside it" in sentences(layer)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("<ISO11783_TaskData><PFD", "cannot be read"),
        ("<ISO11783_TaskData/>", "at least one partfield"),
        ("<!DOCTYPE x><ISO11783_TaskData/>", "document type of its own"),
    ],
)
def test_what_is_no_whole_isoxml_is_refused(tmp_path, content, says):
    (tmp_path / "TASKDATA.XML").write_text(content, encoding="utf-8")
    with pytest.raises(FileProblem, match=says):
        read_isoxml(tmp_path / "TASKDATA.XML", "tasks")
