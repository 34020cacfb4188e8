"""Where records are, in whichever of the ways in which people say it."""

import numpy as np
import pytest
from pyproj import Transformer
from shapely import MultiPoint, Point, box

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer
from fieldmon.io.import_report import Severity
from fieldmon.io.options import ReadOptions
from fieldmon.io.parse.positions import located
from tests.io.tables_of_cells import column, sentences, table

ANY = ReadOptions()
LON, LAT = [35.150123, 35.151456], [30.360789, 30.361012]
X, Y = Transformer.from_crs("OGC:CRS84", "EPSG:2039", always_xy=True).transform(LON, LAT)
PAIRS = [f"{lat}, {lon}" for lon, lat in zip(LON, LAT, strict=True)]

POINTS, IN_METRES = (
    column([Point(place) for place in zip(*xy, strict=True)]) for xy in ((LON, LAT), (X, Y))
)

WAYS = {
    "degrees": (table(lon=LON, lat=LAT), ANY),
    "degrees in words": (table(Longitude=[str(x) for x in LON], Breite=[str(y) for y in LAT]), ANY),
    "together": (table(position=PAIRS), ANY),
    "metres": (table(x=list(X), y=list(Y)), ReadOptions(crs="EPSG:2039")),
    "metres of a stated system": (table(x=list(X), y=list(Y), crs=["EPSG:2039"] * 2), ANY),
    "points": (Layer("p", {"a": column([1, 2])}, POINTS, "OGC:CRS84"), ANY),
    "points in metres": (Layer("p", {}, IN_METRES, "EPSG:2039"), ANY),
}


@pytest.mark.parametrize("way", WAYS)
def test_every_way_of_writing_positions_leads_to_the_same_places(way):
    found = located(*WAYS[way])
    np.testing.assert_allclose(found.lonlat, np.stack([LON, LAT], axis=1), atol=2e-8)
    assert np.isnan(found.accuracy_m).all()
    assert found.plot is None


def test_columns_named_by_hand_go_before_those_that_are_recognised():
    layer = table(lon=[0.0, 0.0], lat=[0.0, 0.0], a=LON, b=LAT, pair=PAIRS)
    for options in (ANY.naming(lon="a", lat="b"), ANY.naming(position="pair")):
        np.testing.assert_allclose(located(layer, options).lonlat[:, 0], LON)


def test_columns_whose_letters_are_crossed_are_exchanged_and_that_is_said():
    layer = table(lon=["30.36 N", "30.37 N"], lat=["35.15 E", "35.16 E"])
    found = located(layer, ANY)
    np.testing.assert_allclose(found.lonlat, [[35.15, 30.36], [35.16, 30.37]])
    assert "Longitudes stood in the column of latitudes" in sentences(found)
    for word in ("lon", "1 N"):  # one cell does not speak for all
        found = located(table(lon=[word, "35.15", "35.16"], lat=["lat", "30.36", "30.37"]), ANY)
        np.testing.assert_allclose(found.lonlat[-2:], [[35.15, 30.36], [35.16, 30.37]])


def test_two_coordinates_in_a_column_whose_order_nothing_tells_are_a_guess_with_a_way_out():
    found = located(table(position=["30.360789, 35.150123"]), ANY)
    (guess,) = [m for m in found.messages if m.severity is Severity.GUESSED]
    assert guess.remedy is not None
    again = located(table(position=["30.360789, 35.150123"]),
                    ANY.choose(guess.remedy.option, guess.remedy.value))  # fmt: skip
    np.testing.assert_allclose(again.lonlat, found.lonlat[:, ::-1])


def test_records_without_a_position_are_left_out_and_one_is_shown():
    found = located(
        table(lon=[35.150123, None, "east"], lat=[30.360789, None, 30.4], n=[1, 2, 3]), ANY
    )
    assert found.layer.columns["n"].tolist() == [1]
    (left_out,) = [m for m in found.messages if m.severity is Severity.DROPPED]
    assert left_out.sentence.startswith("2 records without a usable position")
    assert "'east / 30.4' in record 3" in left_out.sentence
    with pytest.raises(FileProblem, match="not one record has any"):
        located(table(lon=[None, "east"], lat=[None, None]), ANY)


MISTYPED = np.array([*zip(LON, LAT, strict=True), (LON[0], 498.99)])
FAR_UP = np.array([*zip(X, Y, strict=True), (X[0] * 1e4, Y[0])])


@pytest.mark.parametrize(
    ("layer", "said"),
    [
        (table(lon=MISTYPED[:, 0], lat=MISTYPED[:, 1]), "'35.150123 / 498.99' in record 3"),
        (Layer("p", {}, column([Point(p) for p in MISTYPED]), "OGC:CRS84"), "498.99' in record 3"),
        (Layer("p", {}, column([Point(p) for p in FAR_UP]), "EPSG:2039"), "in record 3"),
    ],
)
def test_a_mistyped_coordinate_is_left_out_and_named(layer, said):
    found = located(layer, ANY)
    np.testing.assert_allclose(found.lonlat, np.stack([LON, LAT], axis=1), atol=2e-8)
    (left_out,) = [m.sentence for m in found.messages if m.severity is Severity.DROPPED]
    assert said in left_out
    with pytest.raises((ChoiceNeeded, FileProblem)):  # where most are so, it is something else
        located(layer.take(np.array([0, 2])), ANY)


def test_two_systems_in_one_table_are_asked_apart():
    layer = table(x=list(X), y=list(Y), crs=["EPSG:2039", "EPSG:32636"])
    with pytest.raises(ChoiceNeeded) as asked:
        located(layer, ANY)
    assert (asked.value.option, asked.value.choices) == (
        "where",
        ("crs=EPSG:2039", "crs=EPSG:32636"),
    )


def test_a_system_that_nobody_knows_is_doubted_and_degrees_stay_degrees():
    found = located(table(lon=LON, lat=LAT, geodeticDatum=["Paran grid"] * 2), ANY)
    np.testing.assert_allclose(found.lonlat[:, 0], LON)
    assert "'Paran grid', which is not known" in sentences(found)


def test_a_column_called_datum_may_hold_days():
    found = located(table(lon=LON, lat=LAT, Datum=["2026-04-01", "2026-04-02"]), ANY)
    assert "not known" not in sentences(found)


@pytest.mark.parametrize(("decimals", "coarse"), [(6, False), (5, False), (3, True), (2, True)])
def test_rounded_coordinates_are_used_with_the_accuracy_that_rounding_leaves(decimals, coarse):
    rng = np.random.default_rng(decimals)
    exact = np.array([35.15, 30.36]) + rng.random((400, 2)) * 0.5
    lon, lat = exact.round(decimals).T
    found = located(table(lon=lon.tolist(), lat=lat.tolist()), ANY)
    assert ("rounded to about" in sentences(found)) == coarse
    if coarse:
        off = (found.lonlat - exact) * [111_320 * np.cos(np.radians(30.6)), 110_900]
        one_sigma_m = np.sqrt((off**2).sum(axis=1).mean() / 2)
        assert found.accuracy_m[0] == pytest.approx(np.sqrt(2) * one_sigma_m, rel=0.25)
    else:
        assert np.isnan(found.accuracy_m).all()


def test_several_points_in_a_feature_are_a_record_each_and_other_shapes_are_left_out():
    shapes = [MultiPoint([(5.0, 45.0), (5.1, 45.0)]), box(5, 45, 6, 46), Point(5.2, 45.0), None]
    found = located(Layer("p", {"n": column([1, 2, 3, 4])}, column(shapes), "OGC:CRS84"), ANY)
    assert found.layer.columns["n"].tolist() == [1, 1, 3]
    assert "2 features that are no points" in sentences(found)


# --- records that name a place -----------------------------------------------------------------


def test_small_whole_numbers_called_x_and_y_are_no_places_on_earth():
    with pytest.raises(ChoiceNeeded) as asked:
        located(table(x=[1, 2], y=[3, 4]), ANY)
    assert asked.value.option in {"columns", "plants"}
    far = located(table(x=list(X), y=list(Y)), ReadOptions(crs="EPSG:2039"))
    assert len(far.lonlat) == 2


def test_a_table_without_any_place_asks_for_its_columns():
    with pytest.raises(ChoiceNeeded, match="none were recognised among: crop, n") as asked:
        located(table(crop=["vine"], n=["x"]), ANY)
    assert asked.value.option == "columns"
    assert asked.value.choices == ("plant=crop", "plant=n", "plot=crop", "plot=n")


def test_degrees_with_an_o_are_refused_with_the_letter():
    layer = table(latitud=["33°29'57.5983\"S"] * 2, longitud=["70°00'3.0845\"O", "70.1 O"])
    with pytest.raises(FileProblem, match=r"O can mean west .* or east .*: write W or E"):
        located(layer, ANY)
    for other in ("Oslo", ""):
        with pytest.raises(FileProblem) as told:
            located(table(lat=[other], lon=[other]), ANY)
        assert "O can mean" not in str(told.value)
