"""Plots out of a layer: which features, how they are called, and what is said of the rest."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from pyproj import Transformer
from shapely import LinearRing, LineString, MultiPolygon, Point, Polygon, box

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer
from fieldmon.io.import_report import Severity
from fieldmon.io.options import PlotOptions
from fieldmon.io.readers.plots import named_areas, plot_names, plots_of
from tests.io.tables_of_cells import column, sentences, table

ANY = PlotOptions()
ONE, TWO, THREE = (box(5 + k, 45, 5.001 + k, 45.001) for k in range(3))


def layer_of(shapes, **columns):
    return Layer("estate", {k: column(v) for k, v in columns.items()}, column(shapes), "OGC:CRS84")


def names_of(imported):
    return [field.name for field in imported.value]


def test_plots_are_called_as_their_column_says_and_told_apart_where_it_repeats():
    layer = layer_of([ONE, TWO, THREE], name=["Gate", "Gate", "Pond"])
    assert names_of(plots_of(layer, ANY)) == ["Gate (1)", "Gate (2)", "Pond"]
    assert plot_names(layer, None)[0] == named_areas(layer, ANY)[1]


def test_plots_without_names_are_numbered_and_that_is_a_guess():
    imported = plots_of(layer_of([ONE, TWO]), ANY)
    assert names_of(imported) == ["estate (1)", "estate (2)"]
    assert "they are numbered" in imported.of(Severity.GUESSED)[0].sentence
    assert names_of(plots_of(layer_of([ONE]), ANY)) == ["estate"]


def test_a_column_of_names_can_be_chosen():
    layer = layer_of([ONE, TWO], name=["a", "b"], code=["X1", "X2"])
    assert names_of(plots_of(layer, PlotOptions(name_column="code"))) == ["X1", "X2"]


@pytest.mark.parametrize(
    ("wanted", "name"),
    [("Gate", "Gate"), ("gat", "Gate"), (2, "Pond"), ("2", "Pond"), ("POND", "Pond")],
)
def test_one_plot_is_chosen_by_its_name_a_part_of_it_or_its_number(wanted, name):
    layer = layer_of([ONE, TWO], name=["Gate", "Pond"])
    (field,) = plots_of(layer, PlotOptions(feature=wanted)).value
    assert field.name == name
    assert field.boundary.equals({"Gate": ONE, "Pond": TWO}[name])


@pytest.mark.parametrize(
    ("wanted", "offered"),
    [
        ("Moon", ("Gate 1", "Gate 2", "Pond")),
        ("gate", ("Gate 1", "Gate 2")),
        ("4", None),
        ("0", None),
    ],
)
def test_a_name_that_fits_none_or_several_is_asked_back(wanted, offered):
    layer = layer_of([ONE, TWO, THREE], name=["Gate 1", "Gate 2", "Pond"])
    with pytest.raises(ChoiceNeeded) as asked:
        plots_of(layer, PlotOptions(feature=wanted))
    assert asked.value.option == "feature"
    assert asked.value.choices == (offered or ("Gate 1", "Gate 2", "Pond"))


def test_a_plot_called_by_a_number_goes_before_the_number():
    layer = layer_of([ONE, TWO], name=["2", "1"])
    read = plots_of(layer, PlotOptions(feature=2))
    assert names_of(read) == ["2"]
    said = "2 was taken as the plot's name; number 2 of the list is '1'."
    assert said in sentences(read)
    in_order = layer_of([ONE, TWO], name=["1", "2"])
    assert "taken as the plot's name" not in sentences(plots_of(in_order, PlotOptions(feature=2)))


def test_what_is_no_area_is_left_out_and_counted():
    shapes = [ONE, LineString([(5, 45), (6, 45)]), Point(5, 45), Point(5, 46), None, TWO]
    imported = plots_of(layer_of(shapes, name=list("abcdef")), ANY)
    assert names_of(imported) == ["a", "f"]
    said = [message.sentence for message in imported.of(Severity.DROPPED)]
    assert [sentence.partition(" ")[0] for sentence in said] == ["1", "1", "2"]


def test_lines_that_close_are_the_outlines_of_plots_and_that_is_a_guess():
    ring = LineString(LinearRing([(5, 45), (5.001, 45), (5.001, 45.001)]))
    imported = plots_of(layer_of([ring]), ANY)
    assert imported.value[0].boundary.equals(MultiPolygon([Polygon(ring.coords)]))
    assert "taken as the outlines" in sentences(imported.of(Severity.GUESSED))


def test_lines_and_points_alone_are_offered_as_what_they_can_be():
    with pytest.raises(ChoiceNeeded) as asked:
        plots_of(layer_of([LineString([(5, 45), (6, 45)]), Point(5, 45)]), ANY)
    assert (asked.value.option, asked.value.choices) == ("kind", ("lines", "plants"))
    with pytest.raises(FileProblem, match="without any geometry"):
        plots_of(layer_of([None, None]), ANY)
    with pytest.raises(FileProblem, match="but it is empty"):
        plots_of(layer_of([]), ANY)


def test_parts_and_holes_are_kept_and_said():
    parts = MultiPolygon([ONE, TWO])
    holed = Polygon(box(5, 46, 5.01, 46.01).exterior, [box(5.004, 46.004, 5.006, 46.006).exterior])
    imported = plots_of(layer_of([parts, holed], name=["two", "ring"]), ANY)
    assert [len(field.boundary.geoms) for field in imported.value] == [2, 1]
    assert shapely.area(imported.value[1].boundary) == pytest.approx(shapely.area(holed))
    assert "several parts, which were kept: two." in sentences(imported)
    assert "holes, kept as places without plants: ring." in sentences(imported)
    (own,) = (said for one in imported.messages if one.each for said in one.about("ring"))
    assert str(own) == "seen: ring: It has holes, kept as places without plants."


def test_an_island_in_a_hole_is_doubted_as_routes_lead_across_the_hole():
    hole, island = box(5.004, 46.004, 5.006, 46.006), box(5.0045, 46.0045, 5.0055, 46.0055)
    ring = Polygon(box(5, 46, 5.01, 46.01).exterior, [hole.exterior])
    beside = MultiPolygon([ring, box(5.02, 46, 5.03, 46.01)])
    imported = plots_of(layer_of([MultiPolygon([ring, island]), beside], name=["a", "b"]), ANY)
    assert (
        "doubtful: 1 plot has a part in a hole of another, and routes lead straight across that "
        "hole: a."
    ) in sentences(imported)


def test_the_same_outline_twice_is_doubted_however_it_is_drawn():
    backwards = Polygon(list(ONE.exterior.coords)[::-1])
    imported = plots_of(layer_of([ONE, backwards, TWO], name=["a", "b", "c"]), ANY)
    (doubt,) = imported.of(Severity.DOUBTFUL)
    assert (doubt.feature, doubt.sentence) == ("b", "It has the same outline as a.")


def test_rows_that_the_file_knows_come_with_the_plot_that_is_chosen():
    layer = layer_of([ONE, TWO], name=["a", "b"], row_spacing=[3, 4])
    (field,) = plots_of(layer, PlotOptions(feature="b")).value
    assert field.row_spacing_m == 4.0


def corners(*lonlat, **more):
    lon, lat = zip(*lonlat, strict=True)
    return table(lon=list(lon), lat=list(lat), **more)


def test_a_table_of_corners_in_their_order_is_one_plot_and_that_is_a_guess():
    imported = plots_of(corners(*list(ONE.exterior.coords)[:-1]), ANY)
    (field,) = imported.value
    assert field.boundary.equals(MultiPolygon([ONE]))
    assert "4 positions were taken as the corners" in sentences(imported.of(Severity.GUESSED))


def test_a_table_of_two_plots_asks_which_are_the_corners():
    both = [*list(ONE.exterior.coords)[:-1], *list(TWO.exterior.coords)[:-1]]
    # joined in this order the outlines cross
    both[4], both[5] = both[5], both[4]
    with pytest.raises(ChoiceNeeded) as asked:
        plots_of(corners(*both, part=["a"] * 4 + ["b"] * 4), ANY)
    assert asked.value.option == "where"
    assert set(asked.value.choices) >= {"part=a", "part=b"}


# three rows of eight plants, each row up: through them runs no outline
IN_ROWS = [(5 + 0.0001 * row, 45 + 0.0001 * plant) for row in range(3) for plant in range(8)]
# up, down, up: their line crosses itself nowhere
UP_AND_DOWN = [*IN_ROWS[:8], *IN_ROWS[15:7:-1], *IN_ROWS[16:]]


@pytest.mark.parametrize(
    ("places", "more"),
    [
        (IN_ROWS, {}),
        (IN_ROWS, {"Vine ID": [f"V{k // 2}" for k in range(24)], "variety": ["a", "b"] * 12}),
        (UP_AND_DOWN, {"row": [k // 8 for k in range(24)]}),
    ],
)
def test_plants_in_place_of_a_plot_are_offered_as_plants_and_nothing_else(places, more):
    with pytest.raises(ChoiceNeeded, match="lists 24 positions that are not its corners") as asked:
        plots_of(corners(*places, **more), ANY)
    assert (asked.value.option, asked.value.choices) == ("kind", ("plants",))


def test_a_few_numbered_corners_are_corners_and_so_are_those_that_are_said_to_be():
    at = list(ONE.exterior.coords)[:-1]
    (field,) = plots_of(corners(*at, row=[1, 2, 3, 4]), ANY).value
    assert field.boundary.equals(MultiPolygon([ONE]))
    walked = corners(*IN_ROWS[:8], *IN_ROWS[23:15:-1], *IN_ROWS[8:16], row=["a"] * 16 + ["b"] * 8)
    (field,) = plots_of(walked, PlotOptions(where="row=a")).value
    assert field.boundary.area > 0


def test_a_plot_whose_corners_were_chosen_by_its_name_is_called_so():
    four = table(lon=[5, 5.001, 5.001, 5], lat=[45, 45, 45.001, 45.001], Plot=["East"] * 4)
    (chosen,) = names_of(plots_of(four, PlotOptions(where="Plot=East")))
    (other,) = names_of(plots_of(four, PlotOptions(where="row=East")))
    assert (chosen, other) == ("East", four.name)


MISTYPED = [(5, 45), (5.001, 45), (5.001, 450.01), (5, 45.001)]


def test_a_mistyped_corner_is_refused_and_named_as_without_it_the_plot_is_another():
    said = r"corner 3, 5.001 / 450.01, does not"
    for wrong in (corners(*MISTYPED), layer_of([Polygon(MISTYPED)], name=["X"])):
        with pytest.raises(FileProblem, match=said):
            plots_of(wrong, ANY)
    with pytest.raises(FileProblem, match=r"corner 2, 5.001 / east, does not"):
        plots_of(table(lon=[5, 5.001, 5.001, 5], lat=["45", "east", "45.001", "45.001"]), ANY)
    blocks = layer_of([Polygon(MISTYPED), TWO], name=["X", "X"], part=["a", "b"])
    with pytest.raises(FileProblem, match=f"corner of X / a must.*{said}"):
        plots_of(blocks, ANY.naming(block="part"))


def test_a_plot_with_a_mistyped_corner_is_left_out_and_the_others_stay():
    # as the first corner, it ends the outline too
    for turned in (MISTYPED, [*MISTYPED[2:], *MISTYPED[:2]]):
        read = plots_of(layer_of([Polygon(turned), TWO], name=["X", "Y"]), ANY)
        assert names_of(read) == ["Y"]
        (left_out,) = read.of(Severity.DROPPED)
        number = turned.index(MISTYPED[2]) + 1
        assert (left_out.feature, left_out.remedy) == ("X", None)
        assert left_out.sentence.startswith(f"Corner {number}, 5.001 / 450.01, lies nowhere")


def test_corners_that_enclose_nothing_are_refused():
    with pytest.raises((ChoiceNeeded, FileProblem)):
        plots_of(corners((5, 45), (5.001, 45), (5.002, 45)), ANY)
    with pytest.raises(ChoiceNeeded, match="3 to 1000 positions"):
        plots_of(corners((5, 45), (5.001, 45)), ANY)


def test_a_table_has_no_areas_to_name():
    layer, names = named_areas(table(a=["x"]), ANY)
    assert (len(layer), names) == (0, [])


TIE = Polygon([(35, 30), (35.002, 30.002), (35.002, 30), (35, 30.002)])


def estate(*areas, **columns):
    return layer_of(list(areas), **columns)


def square(i):
    return box(36 + i / 100, 30, 36.002 + i / 100, 30.002)


def test_what_holds_for_many_plots_is_one_line_with_their_number():
    read = plots_of(estate(*[TIE] * 50, square(0)), PlotOptions())
    grave = [str(m) for m in read.messages if m.severity in {"repaired", "doubtful"}]
    assert len(grave) == 2
    assert grave[0].startswith("repaired: 50 shapes were not valid and were repaired; the first is")
    assert grave[1].startswith("doubtful: 49 plots have the same outline as another; the first is")


def test_the_number_of_a_plot_is_its_place_among_those_that_can_be_used():
    flat = Polygon([(35, 30), (35.1, 30), (35.2, 30)])
    file = estate(flat, square(0), flat, square(1), name=["a", "b", "c", "7"])
    assert [f.name for f in plots_of(file, PlotOptions()).value] == ["b", "7"]
    for wanted, name in (("1", "b"), ("2", "7"), ("7", "7"), ("b", "b")):
        read = plots_of(file, PlotOptions(feature=wanted))
        assert [f.name for f in read.value] == [name]
    with pytest.raises(ChoiceNeeded, match="There are 2 plots, but none is called '3'"):
        plots_of(file, PlotOptions(feature="3"))
    tens = estate(square(0), square(1), name=["(10)", "(20)"])
    with pytest.raises(ChoiceNeeded, match=r"none is called '0': several have it .* from 1"):
        plots_of(tens, PlotOptions(feature="0"))


def test_plots_are_named_by_the_column_that_says_anything():
    empty = ["", ""]
    read = plots_of(estate(square(0), square(1), Name=empty, f_name=["N", "S"]), PlotOptions())
    assert [f.name for f in read.value] == ["N", "S"]
    read = plots_of(estate(square(0), Name=["x"], f_name=["N"]), PlotOptions())
    assert [f.name for f in read.value] == ["x"]


def test_spacings_of_columns_come_with_their_plot():
    file = estate(square(0), square(1), name=["a", "b"], row_spacing=[4.0, None], bearing=[0, 70])
    a, b = plots_of(file, PlotOptions()).value
    assert (a.row_spacing_m, a.row_bearing_deg, a.plant_spacing_m) == (4.0, 0.0, None)
    assert (b.row_spacing_m, b.row_bearing_deg) == (None, 70.0)


def test_plots_keep_what_is_said_of_them_where_others_were_left_out():
    flat = Polygon([(35, 30), (35.1, 30), (35.2, 30)])
    read = plots_of(estate(flat, square(0), name=["x", "b"], row_m=[3, 4]), PlotOptions())
    assert [(f.name, f.row_spacing_m) for f in read.value] == [("b", 4.0)]


def test_plots_of_a_file_that_are_written_in_two_utm_zones_are_doubted_and_named():
    def metres(west, zone):
        to = Transformer.from_crs("OGC:CRS84", f"EPSG:326{zone}", always_xy=True).transform
        area = box(west, 31.5, west + 0.002, 31.502)
        return shapely.transform(area, lambda xy: np.stack(to(*xy.T), axis=1))

    shapes, names = [metres(35.9, 36), metres(35.95, 36), metres(36.1, 37)], ["A", "B", "C"]
    layer = Layer("estate", {"name": column(names)}, column(shapes), "EPSG:32636")
    for options, doubted in ((ANY, True), (PlotOptions(feature="C"), True),
                             (PlotOptions(feature="A"), False)):  # fmt: skip
        said = sentences(plots_of(layer, options))
        told = "1 plot lies 551 km from the others (C), but as UTM zone 37 it would lie 14 km from"
        assert (told in said) is doubted
    right = replace(layer, geometry=column([*shapes[:2], metres(36.1, 36)]))
    assert "UTM zone 37" not in sentences(plots_of(right, ANY))
    columns = {"name": column(names), "utm_zone": column([36, 36, 37])}
    with pytest.raises(ChoiceNeeded, match="'utm_zone' names 2: 36, 37") as asked:
        plots_of(replace(layer, columns=columns), ANY)
    assert asked.value.option == "where"
    unstated = replace(layer.take(np.array([0, 1])), crs=None, columns={"huso": column([36, 36])})
    assert len(plots_of(unstated, ANY).value) == 2
