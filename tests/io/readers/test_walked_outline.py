"""A phone's corners and a walk round a plot are its outline; plants and bow-ties are none."""

import numpy as np
import pytest
from shapely import LineString, MultiPoint, Point, Polygon

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Severity
from fieldmon.io.options import PlotOptions
from fieldmon.io.read import read_plots
from fieldmon.io.readers.plots import plots_of
from fieldmon.io.readers.walked_outline import outline_of
from tests.io.readers.plot_layers import corners, layer_of
from tests.io.tables_of_cells import sentences
from tests.walked import FRAME, walked

ANY, YES = PlotOptions(), PlotOptions(outline=True)
PLOT = [(0, 0), (160, 10), (150, 110), (-5, 100)]
BOW_TIE = [PLOT[k] for k in (0, 2, 1, 3)]


def on_earth(xy_m):
    return FRAME.lonlat(np.array(xy_m, float))


AT = on_earth(PLOT)
STOOD = walked(PLOT, 3, 1, stand=20)[:-1]


def area_of(imported):
    (field,) = imported.value
    return FRAME.geometry_m(field.boundary).area


# --- the outline of positions ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("step_m", "noise_m", "stand"), [(3, 1, 0), (1, 1, 0), (3, 3, 0), (8, 3, 0), (3, 1, 20)]
)
def test_loops_of_noise_are_cut_off_and_the_area_stays(step_m, noise_m, stand):
    for seed in range(4):
        fixes = walked(PLOT, step_m, noise_m, stand=stand, seed=seed)[:-1]
        outline = outline_of(fixes)
        assert (outline.n_loops == 0) == Polygon(fixes).is_valid
        assert outline.area.is_valid
        assert outline.area.area == pytest.approx(Polygon(PLOT).area, rel=0.05)


def test_who_walks_on_past_the_first_corner_has_walked_around():
    fixes = walked(PLOT)
    outline = outline_of(np.concatenate([fixes, fixes[1:6] + 0.5]))
    assert outline.area.area == pytest.approx(Polygon(PLOT).area, rel=0.05)


def test_an_outline_that_crosses_nowhere_stays_to_the_bit():
    assert outline_of(np.array(PLOT, float)).area.equals_exact(Polygon(PLOT), 0.0)


def planted(how):
    y, x = np.meshgrid(np.arange(6) * 4.0, np.arange(20) * 3.0, indexing="ij")
    plants = np.stack([x, y], axis=-1) + np.random.default_rng(1).normal(0, 0.2, (6, 20, 2))
    if how == "anyhow":
        return np.random.default_rng(0).permutation(plants.reshape(-1, 2))
    return (plants.swapaxes(0, 1) if how == "across" else plants).reshape(-1, 2)


@pytest.mark.parametrize("xy", [planted("along"), planted("across"), planted("anyhow")])
def test_through_plants_runs_no_outline(xy):
    assert outline_of(xy) is None


def test_a_bow_tie_two_corners_and_places_in_a_line_are_no_outline():
    assert outline_of(np.array(BOW_TIE, float)) is None
    assert outline_of(np.array(PLOT[:2], float)) is None
    assert outline_of(np.array([(0, 0), (1, 1), (2, 2.0)])) is None
    assert outline_of(np.zeros((5, 2))) is None
    out_and_back = np.array([(k, 0.1 * (k % 2)) for k in [*range(20), *range(18, 0, -1)]])
    assert outline_of(out_and_back) is None


# --- tables ----------------------------------------------------------------------------------


def test_a_walk_in_which_somebody_stood_is_a_plot_and_what_was_mended_is_said():
    read = plots_of(corners(*on_earth(STOOD)), ANY)
    assert area_of(read) == pytest.approx(Polygon(PLOT).area, rel=0.05)
    (said,) = [one.sentence for one in read.of(Severity.REPAIRED)]
    assert said.startswith("The outline crossed itself in ")


def test_a_column_of_their_numbers_gives_the_order_of_corners():
    read = plots_of(corners(*AT[[2, 0, 3, 1]], corner=["3", "1", "4", "2"]), ANY)
    assert area_of(read) == pytest.approx(Polygon(PLOT).area, rel=1e-4)
    assert "Corners were taken in the order of column 'corner'." in sentences(read)
    plain = plots_of(corners(*AT, corner=["1", "2", "3", "4"]), ANY)
    assert "column 'corner'" not in sentences(plain)
    with pytest.raises(FileProblem, match="crosses itself"):
        plots_of(corners(*on_earth(BOW_TIE), corner=["a", "b", "c", "d"]), ANY)


def test_four_corners_that_cross_are_told_how_to_be_put_right_and_are_not_called_plants():
    with pytest.raises(FileProblem, match="number them in a column called corner") as told:
        plots_of(corners(*on_earth(BOW_TIE)), ANY)
    assert "plants" not in str(told.value)


@pytest.mark.parametrize(
    "read",
    [
        lambda: plots_of(corners(*AT[:3]), ANY),
        lambda: plots_of(layer_of([MultiPoint(AT[:3])]), YES),
        lambda: plots_of(layer_of([LineString(AT[:3])]), YES),
    ],
)
def test_three_corners_are_doubted(read):
    (doubt,) = read().of(Severity.DOUBTFUL)
    assert doubt.sentence.startswith("3 corners make a triangle")


# --- points and lines ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shapes", "says"),
    [
        ([Point(at) for at in AT], "4 points"),
        ([MultiPoint(AT)], "4 points"),
        ([LineString(AT)], "4 positions on a line that does not close"),
    ],
)
def test_corners_as_points_or_an_open_line_are_asked_about_and_taken(shapes, says):
    layer = layer_of(shapes, name=["North"] * len(shapes))
    with pytest.raises(ChoiceNeeded, match=f"holds {says}") as asked:
        plots_of(layer, ANY)
    assert (asked.value.option, asked.value.choices) == ("outline", ("yes",))
    read = plots_of(layer, ANY.choose("outline", "yes"))
    assert area_of(read) == pytest.approx(Polygon(PLOT).area, rel=1e-4)
    assert read.value[0].name == "North"
    assert "4 positions were taken as the corners" in sentences(read.of(Severity.GUESSED))


def test_points_through_which_no_outline_runs_stay_what_they_were():
    plants = layer_of([Point(at) for at in on_earth(planted("along"))])
    ties = layer_of([Point(at) for at in on_earth(BOW_TIE)])
    numbered = layer_of([Point(at) for at in on_earth(walked(PLOT, 8, 0))], row=["1"] * 62)
    for layer in (plants, ties, numbered):
        for options in (ANY, YES):
            with pytest.raises(ChoiceNeeded, match="holds only") as asked:
                plots_of(layer, options)
            assert asked.value.option == "kind"


def test_a_line_that_ends_near_where_it_begins_is_an_outline_and_that_is_said():
    read = plots_of(layer_of([LineString(on_earth(STOOD))], name=["North"]), ANY)
    assert area_of(read) == pytest.approx(Polygon(PLOT).area, rel=0.05)
    said = "line that ends near where it begins was taken as the outlines of plots, and closed."
    assert said in sentences(read.of(Severity.GUESSED))
    assert "crossed itself" in sentences(read.of(Severity.REPAIRED))
    there = on_earth([(x, 0) for x in range(0, 100, 5)])
    path = LineString(np.concatenate([there, there[::-1] + 1e-6]))
    with pytest.raises(ChoiceNeeded, match="holds only 1 line"):
        plots_of(layer_of([path]), ANY)


# --- GPX -------------------------------------------------------------------------------------


def gpx(path, kind, xy_m):
    whole, each = {"wpt": ("", "wpt"), "rte": ("rte", "rtept"), "trk": ("trk", "trkpt")}[kind]
    fixes = "".join(f'<{each} lat="{lat:.7f}" lon="{lon:.7f}"/>' for lon, lat in on_earth(xy_m))
    fixes = f"<trkseg>{fixes}</trkseg>" if kind == "trk" else fixes
    held = f"<{whole}><name>North</name>{fixes}</{whole}>" if whole else fixes
    space = "http://www.topografix.com/GPX/1/1"
    path.write_text(f'<gpx version="1.1" creator="phone" xmlns="{space}">{held}</gpx>')
    return path


def test_a_track_of_a_walk_is_the_plot_without_a_question_of_layers(tmp_path):
    read = read_plots(gpx(tmp_path / "walk.gpx", "trk", walked(PLOT)[:-1]))
    assert area_of(read) == pytest.approx(Polygon(PLOT).area, rel=0.02)
    assert read.value[0].name == "North"


@pytest.mark.parametrize("kind", ["wpt", "rte", "trk"])
def test_corners_in_a_gpx_file_are_asked_about_and_taken(tmp_path, kind):
    file = gpx(tmp_path / "corners.gpx", kind, PLOT)
    with pytest.raises(ChoiceNeeded) as asked:
        read_plots(file)
    assert asked.value.option == "outline"
    assert area_of(read_plots(file, YES)) == pytest.approx(Polygon(PLOT).area, rel=1e-3)
