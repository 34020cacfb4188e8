"""A plot that is drawn: positions as people have them, what is no plot, the file it makes."""

import json
import re

import numpy as np
import pytest
from shapely import LinearRing, box

from app.state import brought_files, drawn_plot, plot_source, widget_memory
from app.state.drawn_plot import DrawnCorners, checked, place_of
from app.state.plot_edits import Edit
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.errors import SettingError
from fieldmon.io.options import PlotOptions, Upload
from fieldmon.io.read import read_plots
from fieldmon.plot.projection import Frame

UNITS = UnitsInLanguage()
SQUARE = ((34.9, 31.5), (34.902, 31.5), (34.902, 31.502), (34.9, 31.502))
BOW_TIE = (SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3])


@pytest.fixture(autouse=True)
def own_files(session):
    widget_memory.put(plot_source.KEY, plot_source.FILES)
    return session


@pytest.mark.parametrize(
    "text",
    [
        "31.5012, 34.9034",
        " (31.5012 34.9034) ",
        "31.5012 N, 34.9034 E",
        "E 34.9034, N 31.5012",
        "https://www.openstreetmap.org/#map=17/31.5012/34.9034",
        "https://www.openstreetmap.org/?mlat=31.5012&mlon=34.9034#map=5/48.0/2.0",
        "https://www.google.com/maps/@31.5012,34.9034,17z",
        "https://www.google.com/maps/place/x/@1.0,2.0,17z/data=!3m1!4b1!8m2!3d31.5012!4d34.9034",
        "https://www.google.com/maps/search/31.5012,+34.9034?entry=tts",
        "https://maps.google.com/?q=31.5012%2C34.9034",
        "https://maps.apple.com/?ll=31.5012,34.9034&q=Vineyard",
        "https://www.bing.com/maps?cp=31.5012~34.9034&lvl=16",
        "https://waze.com/ul?ll=31.5012%2C34.9034&navigate=yes",
        "https://yandex.com/maps/?ll=34.9034%2C31.5012&z=17",
        "geo:31.5012,34.9034",
        "geo:0,0?q=31.5012,34.9034(Vineyard)",
    ],
)
def test_a_position_is_read_as_people_and_maps_write_it(text):
    assert place_of(text).lonlat == pytest.approx((34.9034, 31.5012))


def test_where_nothing_says_the_order_it_can_be_turned_but_a_link_never():
    assert not place_of("31.5, 34.9").is_certain
    assert place_of("31.5, 34.9", longitude_first=True).lonlat == (31.5, 34.9)
    for text in ("31.5 N, 34.9 E", "geo:31.5,34.9", "134.9, 31.5"):
        found = place_of(text, longitude_first=True)
        assert found.is_certain
        assert found.lonlat[1] == 31.5


def test_a_comma_is_read_as_the_language_writes_fractions(speaking):
    speaking("es")
    assert place_of("31,5012 34,9034").lonlat == pytest.approx((34.9034, 31.5012))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "must be written"),
        ("near the river", "must be written"),
        ("31.5", "must be written"),
        ("134.9, 231.5", "lies in"),
        ("https://maps.app.goo.gl/Xy12345", "holds none"),
        ("https://example.org/plots/12+34/", "holds none"),
        ("https://www.google.com/maps/@31.5,234.9,17z", "lies in"),
    ],
)
def test_what_holds_no_position_is_refused_in_a_sentence(text, says):
    with pytest.raises(SettingError, match=says):
        place_of(text)


@pytest.mark.parametrize(
    ("corners", "says"),
    [
        ((), "but 0 are set"),
        (SQUARE[:2], "but 2 are set"),
        ((*SQUARE[:2], SQUARE[1], SQUARE[0]), "but 2 are set"),
        (BOW_TIE, "after corner 1 meets the one after corner 3"),
        ((*SQUARE[:2], (34.901, 31.5)), "must not cross itself"),
        ((*SQUARE[:3], (34.9, 31.95)), "within 10.00 km, but .* 49.90 km"),
        (((34.9, 31.5), (34.90001, 31.5), (34.90001, 31.50001)), "these 3 enclose next to none"),
    ],
)
def test_corners_that_are_no_plot_are_refused_in_a_sentence(corners, says):
    with pytest.raises(SettingError) as refused:
        checked(corners, UNITS)
    said = str(refused.value).replace("\u00a0", " ")
    assert re.search(says, said), said


def test_corners_come_in_either_direction_and_twice():
    assert checked(SQUARE, UNITS) == SQUARE
    assert checked(SQUARE[::-1], UNITS) == SQUARE[::-1]
    assert checked((SQUARE[0], *SQUARE, SQUARE[0]), UNITS) == (*SQUARE[:1], *SQUARE[1:])


def test_edges_and_area_are_those_of_the_ellipsoid():
    x, y = Frame(*SQUARE[0]).xy_m(SQUARE).T
    south, east, *_ = lengths = drawn_plot.edges_m(SQUARE).tolist()
    assert lengths == pytest.approx(np.hypot(np.roll(x, -1) - x, np.roll(y, -1) - y), abs=1e-3)
    assert drawn_plot.drawn_area_m2(SQUARE) == pytest.approx(south * east, rel=1e-4)
    assert drawn_plot.edges_m(SQUARE[:2]).tolist() == [south]
    assert drawn_plot.edges_m(()).tolist() == drawn_plot.edges_m(SQUARE[:1]).tolist() == []
    assert drawn_plot.drawn_area_m2(BOW_TIE) == 0


def draw(corners, at=None):
    drawn_plot.keep(DrawnCorners(corners, at))
    drawn_plot.use(UNITS)


def test_what_is_drawn_is_a_file_with_that_boundary_in_wgs84():
    assert not drawn_plot.is_open()
    drawn_plot.begin()
    assert drawn_plot.is_open()
    draw(SQUARE)
    assert not drawn_plot.is_open()
    file = brought_files.brought()[brought_files.PLOT]
    (field,) = read_plots(file.source, PlotOptions()).value
    assert field.name == texts.OUTLINE_NAME
    assert field.boundary.equals(box(34.9, 31.5, 34.902, 31.502))
    assert list(brought_files.brought()) == [brought_files.PLOT]


def test_corners_without_a_plot_are_drawn_on_after_a_reload(session):
    drawn_plot.begin()
    drawn_plot.keep(DrawnCorners(SQUARE[:2], SQUARE[0]))
    kept = brought_files.brought()
    session.clear()
    widget_memory.put(plot_source.KEY, plot_source.FILES)
    assert not drawn_plot.is_open()
    brought_files.brought().update(kept)
    assert drawn_plot.is_open()
    assert drawn_plot.so_far() == DrawnCorners(SQUARE[:2], SQUARE[0])
    widget_memory.put(plot_source.KEY, plot_source.SAMPLE)
    assert not drawn_plot.is_open()


def test_a_plot_is_corrected_and_keeps_what_was_said_and_drawn_of_it(session):
    draw(SQUARE)
    key = brought_files.brought()[brought_files.PLOT].key
    gate = (Edit("gate", SQUARE[:1]),)
    session[f"edits {key}PlotOptions()0"] = gate
    widget_memory.put(f"row_spacing {key}PlotOptions()0", 2.5)
    drawn_plot.correct()
    assert drawn_plot.is_open()
    assert drawn_plot.so_far().corners == SQUARE
    draw((*SQUARE[:3], (34.9, 31.503)))
    new = brought_files.brought()[brought_files.PLOT].key
    assert new != key
    assert session[f"edits {new}PlotOptions()0"] == gate
    assert widget_memory.value(f"row_spacing {new}PlotOptions()0") == 2.5


@pytest.mark.parametrize("corners", [SQUARE, SQUARE[::-1]])
def test_corners_keep_their_numbers_and_edges_their_lengths_when_they_are_corrected(corners):
    tapped = tuple((lon + 3e-8, lat - 4e-8) for lon, lat in corners)
    drawn_plot.keep(DrawnCorners(tapped))
    before = drawn_plot.so_far().corners
    draw(tapped)
    drawn_plot.correct()
    assert drawn_plot.so_far().corners == before == corners


def test_the_file_for_other_programs_goes_round_as_geojson_does_from_the_same_corner():
    for corners in (SQUARE, SQUARE[::-1]):
        draw(corners)
        (ring,) = json.loads(drawn_plot.to_download())["geometry"]["coordinates"]
        assert LinearRing(ring).is_ccw
        assert tuple(ring[0]) == corners[0]
    brought_files.take_out(brought_files.PLOT)
    assert drawn_plot.to_download() is None


def test_what_is_left_uncorrected_stays_as_it_was():
    draw(SQUARE)
    before = drawn_plot.data_of_plot()
    drawn_plot.correct()
    drawn_plot.keep(DrawnCorners(SQUARE[:2]))
    drawn_plot.leave()
    assert not drawn_plot.is_open()
    assert drawn_plot.data_of_plot() == before
    assert drawn_plot.so_far() == DrawnCorners()


def test_what_is_begun_waits_while_files_are_looked_for():
    drawn_plot.begin()
    drawn_plot.keep(DrawnCorners(SQUARE[:2]))
    drawn_plot.leave()
    assert not drawn_plot.is_open()
    drawn_plot.begin()
    assert drawn_plot.so_far().corners == SQUARE[:2]


def test_a_file_that_was_downloaded_can_be_corrected_and_no_other():
    name = "כרם"
    data = drawn_plot.geojson(SQUARE, name)
    brought_files.keep_uploads(brought_files.PLOT, (Upload("plot.geojson", data),))
    assert drawn_plot.corners_of_plot() == SQUARE
    drawn_plot.correct()
    drawn_plot.use(UNITS)
    assert json.loads(drawn_plot.data_of_plot())["properties"]["name"] == name
    for other in (b"", b"{}", b"[1]", data + b" ", data.replace(b'"name"', b'"nom"')):
        brought_files.keep_uploads(brought_files.PLOT, (Upload("plot.geojson", other),))
        assert drawn_plot.data_of_plot() is None
        assert drawn_plot.corners_of_plot() == ()
