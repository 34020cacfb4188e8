"""Plants out of points and tables, rows and paths out of lines."""

from dataclasses import replace

import numpy as np
import pytest
from pyproj import Transformer
from shapely import LineString, MultiLineString, MultiPoint, Point, box

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer
from fieldmon.io.import_report import Severity
from fieldmon.io.options import ReadOptions
from fieldmon.io.readers.points_and_lines import drawn_rows_of, lines_of, plants_of
from tests.io.tables_of_cells import column, sentences, table

ANY = ReadOptions()
WGS84 = "OGC:CRS84"


def layer_of(shapes, crs=WGS84, **columns):
    return Layer("shapes", {k: column(v) for k, v in columns.items()}, column(shapes), crs)


def test_plants_keep_their_places_and_what_their_file_calls_them():
    shapes = [Point(5.0, 45.0), Point(5.00001, 45.0)]
    imported = plants_of(layer_of(shapes, row=["1", "1"], vine=["7", "8"]), ANY)
    np.testing.assert_array_equal(imported.value.lonlat, [[5.0, 45.0], [5.00001, 45.0]])
    assert imported.value.row.tolist() == ["1", "1"]
    assert imported.value.plant.tolist() == ["7", "8"]
    assert "'vine' names the plants" in sentences(imported)


def test_the_number_in_the_row_names_plants_before_one_that_counts_over_the_whole_plot():
    """As in the layer of plants that fieldmon itself writes."""
    shapes = [Point(5.0 + k * 1e-5, 45.0) for k in range(3)]
    own = {"line": [1, 1, 2], "number": [5, 6, 1]}
    layer = layer_of(shapes, plant=[0, 1, 2], **own)
    imported = plants_of(layer, ANY)
    assert imported.value.plant.tolist() == ["5", "6", "1"]
    assert "'number' names the plants" in sentences(imported)
    assert plants_of(layer, ANY.naming(plant="plant")).value.plant.tolist() == ["0", "1", "2"]
    # names stay names, and what tells no plant from another names none
    named = plants_of(layer_of(shapes, plant=["A1", "A2", "B1"], **own), ANY)
    assert named.value.plant.tolist() == ["A1", "A2", "B1"]
    alike = plants_of(layer_of(shapes, plant=[0, 1, 2], line=[1, 1, 1], number=[8, 8, 8]), ANY)
    assert alike.value.plant.tolist() == ["0", "1", "2"]


@pytest.mark.parametrize("faces", [["1", "2", "2", "1"], ["a", "B", "b", "A"]])
def test_both_faces_of_plants_are_no_doubles_and_how_to_inspect_both_is_said(faces):
    shapes = [Point(5.0 + k * 1e-5, 45.0) for k in (0, 0, 1, 1)]
    imported = plants_of(layer_of(shapes, vine=[7, 7, 8, 8], face=faces), ANY)
    assert imported.value.plant.tolist() == ["7", "8"]
    assert "Column 'face' names both faces of 2 plants" in sentences(imported)
    assert "Inspect both faces" in sentences(imported)
    for others in (["1", "1", "1", "2"], ["north", "south", "north", "south"]):
        with pytest.raises(ChoiceNeeded, match="No two plants may stand in one place"):
            plants_of(layer_of(shapes, vine=[7, 7, 8, 8], face=others), ANY)


def test_what_is_not_called_anything_has_no_label():
    plants = plants_of(table(lat=[45.0, 45.1], lon=[5.0, 5.1]), ANY).value
    assert plants.row.tolist() == plants.plant.tolist() == ["", ""]
    assert len(plants) == 2


def test_names_of_rows_that_some_plants_lack_do_not_tell_of_rows_and_that_is_said():
    shapes = [Point(5.0 + k * 1e-5, 45.0) for k in range(3)]
    imported = plants_of(layer_of(shapes, row=["1", "", "2"]), ANY)
    assert "Column 'row' is empty for 1 of 3 plants: its names do not tell" in sentences(imported)
    assert "empty" not in sentences(plants_of(layer_of(shapes, row=["1", "1", "2"]), ANY))


def test_several_points_in_one_feature_are_a_plant_each():
    shapes = [MultiPoint([(5.0, 45.0), (5.1, 45.0)]), Point(5.2, 45.0)]
    plants = plants_of(layer_of(shapes, row=["1", "2"]), ANY).value
    assert plants.lonlat[:, 0].tolist() == [5.0, 5.1, 5.2]
    assert plants.row.tolist() == ["1", "1", "2"]


def test_two_plants_at_one_place_are_asked_about_by_name_and_one_of_each_can_be_kept():
    layer = layer_of([Point(5, 45)] * 3 + [Point(5.1, 45)], vine=list("abcd"))
    with pytest.raises(ChoiceNeeded, match=r"2 of 4 are within 5 cm of .* them 'b'") as asked:
        plants_of(layer, ANY)
    imported = plants_of(layer, ANY.choose(asked.value.option, asked.value.choices[0]))
    assert imported.value.plant.tolist() == ["a", "d"]
    (left,) = imported.of(Severity.DROPPED)
    assert left.sentence.startswith("2 of 4 plants stood within 5 cm of another one")


def test_plants_far_from_all_others_are_named_and_left_out_in_another_part_of_the_earth():
    rows = [(5.0 + 3e-5 * k, 45.0 + 4e-5 * row) for row in range(3) for k in range(10)]
    near = [(5.01, 45.0), (5.01, 45.00001)]
    strays = [*rows, *near, (5.1, 45.0), (0.0, 0.0)]
    names = [f"v{k}" for k in range(len(strays))]
    imported = plants_of(layer_of([Point(p) for p in strays], vine=names), ANY)
    assert imported.value.plant.tolist() == names[:-2]
    gone, away, stray = (m for m in imported.messages if m.severity is not Severity.SEEN)
    assert (gone.severity, "v33 (0.00000 / 0.00000)" in gone.sentence) == (Severity.DROPPED, True)
    assert away.severity is Severity.DROPPED
    assert "1 plant stands 7.86 km" in away.sentence
    assert "from the others and was left out: v32" in away.sentence
    kept = plants_of(
        layer_of([Point(p) for p in strays], vine=names),
        ANY.choose(away.remedy.option, away.remedy.value),
    )
    assert kept.value.plant.tolist() == names[:-1]
    assert stray.severity is Severity.DOUBTFUL
    assert "2 plants stand 7" in stray.sentence
    assert " m and more from the others: v30 (5.01000 / 45.00000), v31" in stray.sentence
    fine = plants_of(layer_of([Point(p) for p in rows], vine=names[:-3]), ANY)
    assert {m.severity for m in fine.messages} == {Severity.SEEN}


def test_plants_can_be_named_by_hand():
    options = ANY.naming(row="b", plant="a")
    shapes = [Point(5.0, 45.0)]
    plants = plants_of(layer_of(shapes, a=["7"], b=["3"], row=["9"]), options).value
    assert (plants.row[0], plants.plant[0]) == ("3", "7")


def test_a_column_that_is_the_same_for_all_names_no_plant_unless_it_is_named_by_hand():
    shapes = [Point(5.0, 45.0), Point(5.00001, 45.0)]
    layer = layer_of(shapes, field=["11", "11"])
    imported = plants_of(layer, ANY)
    assert imported.value.plant.tolist() == ["", ""]
    assert "names the plants" not in sentences(imported)
    assert plants_of(layer, ANY.naming(plant="field")).value.plant.tolist() == ["11", "11"]
    assert plants_of(layer_of(shapes[:1], field=["11"]), ANY).value.plant.tolist() == ["11"]


CORNERS = [Point(5.0, 45.0), Point(5.001, 45.0), Point(5.001, 45.001), Point(5.0, 45.001)]
WITHIN = [Point(5.0001 + 0.0001 * (i % 5), 45.0001 + 0.0001 * (i // 5)) for i in range(15)]


def test_corners_of_a_plot_among_its_plants_are_no_plants_until_somebody_says_that_they_are():
    layer = layer_of([*CORNERS, *WITHIN], marker=["polygon"] * 4 + ["planta"] * 15)
    imported = plants_of(layer, ANY)
    (said,) = (one for one in imported.messages if one.remedy is not None)
    assert said.severity == Severity.DROPPED
    assert "4 of 19 plants, with marker=polygon, go round the others" in said.sentence
    assert len(imported.value) == 15
    (option, value) = said.remedy.setting.split("=")
    kept = plants_of(layer, replace(ANY, **{option: value}))
    assert len(kept.value) == 19
    (said,) = (one for one in kept.messages if one.remedy is not None)
    assert said.severity == Severity.DOUBTFUL
    assert "4 of 19 plants, with marker=polygon, go round the others" in said.sentence
    assert said.remedy.setting == "where=marker=planta"
    assert len(plants_of(layer.where(said.remedy.value), ANY).value) == 15
    # among the others they are plants of another kind
    kinds = layer_of([*WITHIN, *CORNERS], kind=[*"bbcc", *"a" * 15])
    assert "go round" not in sentences(plants_of(kinds, ANY))


def test_lines_come_in_whole_and_what_leads_nowhere_is_left_out_and_said():
    whole, nowhere = LineString([(5, 45), (5.1, 45)]), LineString([(5, 45), (5, 45)])
    several = MultiLineString([[(5, 45), (5, 45.1)], [(6, 45), (6, 45.1)]])
    imported = lines_of(layer_of([whole, several, nowhere, Point(5, 45), None]), ANY)
    wanted = [whole, *several.geoms]
    assert len(imported.value.geoms) == len(wanted)
    assert all(line.equals(other) for line, other in zip(imported.value.geoms, wanted, strict=True))
    said = sentences(imported)
    assert "2 features that are no lines" in said
    assert "1 line that leads nowhere" in said


def test_lines_are_read_in_the_system_they_are_in():
    metres = LineString([(706_700, 3_360_800), (706_800, 3_360_800)])
    (line,) = lines_of(layer_of([metres], "EPSG:32636"), ANY).value.geoms
    there = Transformer.from_crs(32636, "OGC:CRS84", always_xy=True).transform(706_700, 3_360_800)
    assert line.coords[0] == pytest.approx(there, abs=1e-9)


@pytest.mark.parametrize(
    ("layer", "words"),
    [
        (table(lat=[45.0], lon=[5.0]), "but it is a plain table"),
        (layer_of([box(5, 45, 6, 46), Point(5, 45)]), r"it holds 1 area and 1 point"),
    ],
)
def test_what_holds_no_line_is_refused_with_what_it_holds(layer, words):
    with pytest.raises(FileProblem, match=words):
        lines_of(layer, ANY)


def test_areas_are_no_plants_and_a_table_without_places_asks():
    with pytest.raises(FileProblem, match=r"must hold points, but it holds 1 area"):
        plants_of(layer_of([box(5, 45, 6, 46)]), ANY)
    with pytest.raises(ChoiceNeeded) as asked:
        plants_of(table(a=["x"], b=["y"]), ANY)
    assert asked.value.option == "columns"


def test_plants_without_names_are_not_called_by_where_they_stand():
    cells = table(lon=["35.1416", "35.1417", "35.1416"], lat=["30.35", "30.35", "30.35"])
    with pytest.raises(ChoiceNeeded, match="the first of them one without a name"):
        plants_of(cells, ANY)


@pytest.mark.parametrize("posts", [False, True])
def test_names_of_rows_that_are_drawn_are_told_to_be_lost(posts):
    ends = [(5.0, 45.0), (5.001, 45.0), (5.0, 45.001), (5.001, 45.001)]
    shapes = [Point(one) for one in ends] if posts else [LineString(ends[:2]), LineString(ends[2:])]
    names = ["12", "12", "11", "11"] if posts else ["12", "11"]
    imported = drawn_rows_of(layer_of(shapes, row=names), ANY)
    assert "doubtful: Rows that are drawn count from 1 here, whatever column 'row'" in sentences(
        imported
    )
    for unnamed in ({}, {"row": [""] * len(shapes)}):
        assert "calls them" not in sentences(drawn_rows_of(layer_of(shapes, **unnamed), ANY))


def test_rows_that_are_drawn_twice_either_way_count_once():
    one, other = LineString([(5.0, 45.0), (5.001, 45.0)]), LineString([(5.0, 45.1), (5.001, 45.1)])
    imported = drawn_rows_of(layer_of([one, other, one, other.reverse()]), ANY)
    assert list(imported.value.geoms) == [one, other]
    assert "dropped: 2 rows are in the file twice and count once." in sentences(imported)
