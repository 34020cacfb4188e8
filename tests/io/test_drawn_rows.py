"""Rows and blocks that come with one plot or with many."""

from itertools import pairwise

import geopandas as gpd
import numpy as np
import pytest
import rasterio
import shapely
from pyproj import Transformer
from rasterio.transform import from_origin
from shapely import LineString, MultiLineString, MultiPolygon

from fieldmon.errors import PlotError, SettingError
from fieldmon.io.drawn_rows import blocks_of_each, blocks_on, cut_each, guess_each, rows_of_each
from fieldmon.io.options import PlotOptions
from fieldmon.io.plot_request import PlantingChoices, PlotRequest, PlotSources
from fieldmon.io.prepare import prepare, prepare_estate
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.grid import block_number
from fieldmon.plot.projection import Frame

FRAME = Frame(8.0, 47.0)
BOXES = {"west": shapely.box(0, 0, 80, 60), "east": shapely.box(100, 0, 180, 60)}
FIELDS = tuple(
    Field(name, FRAME.geometry_lonlat(MultiPolygon([box]))) for name, box in BOXES.items()
)


def line(*corners):
    return LineString(FRAME.lonlat(corners))


def block(name, *bounds):
    return Block(name, FRAME.geometry_lonlat(MultiPolygon([shapely.box(*bounds)])))


def write(path, shapes, **columns):
    placed = [FRAME.geometry_lonlat(shape) for shape in shapes]
    gpd.GeoDataFrame(columns, geometry=placed, crs=4326).to_file(path)
    return path


def said(imported):
    return " ".join(message.sentence for message in imported.messages)


def sentences(prepared):
    return " ".join(one.message.sentence for one in prepared.messages)


def test_each_of_many_plots_gets_its_own_rows_and_those_on_none_are_said():
    rows = [line((5, y), (75, y + 5)) for y in (10, 20, 30)] + [line((300, 0), (360, 0))]
    imported = rows_of_each(FIELDS, MultiLineString(rows))
    assert [len(field.row_lines.geoms) for field in imported.value] == [3, 0]
    assert "1 row that lies on no plot was left out." in said(imported)
    assert "On 1 of 2 plots no rows were drawn" in said(imported)


def test_blocks_lie_on_their_plot_and_none_over_another():
    areas = (block("a", -5, -5, 40, 65), block("b", 30, -5, 60, 65), block("far", 500, 0, 540, 40))
    blocks, messages = blocks_on(FIELDS[0], areas)
    assert [one.name for one in blocks] == ["a", "b"]
    assert FRAME.geometry_m(blocks[0].area).area == pytest.approx(40 * 60, rel=1e-4)
    assert FRAME.geometry_m(blocks[1].area).area == pytest.approx(20 * 60, rel=1e-4)
    told = " ".join(message.sentence for message in messages)
    assert "Rows run in 2 blocks as drawn: a, b." in told
    assert "Blocks lie over others: b. The first one counts." in told
    assert "25 % of the plot (1200 m2) lies in no block" in told


def test_blocks_beside_all_plots_are_refused_and_left_over_ones_counted():
    with pytest.raises(PlotError, match="none of 1 does"):
        blocks_of_each(FIELDS, (block("far", 500, 0, 540, 40),))
    mixed = (block("a", 0, 0, 80, 60), block("b", 100, 0, 180, 60), block("far", 500, 0, 540, 40))
    imported = blocks_of_each(FIELDS, mixed)
    assert [len(field.blocks) for field in imported.value] == [1, 1]
    assert "1 block lies on none of the plots" in said(imported)


def test_lines_part_the_plots_they_pass_through():
    across = MultiLineString([line((40, -5), (40, 65)), line((140, -5), (140, 65))])
    imported = cut_each(FIELDS, across)
    assert [len(field.blocks) for field in imported.value] == [2, 2]
    assert "2 lines part plots into 4 blocks." in said(imported)
    idle = MultiLineString([line((40, -5), (40, 65)), line((300, -5), (300, 65))])
    assert "1 line passes through no plot" in said(cut_each(FIELDS[:1], idle))
    with pytest.raises(PlotError, match="none of 2 lines does"):
        cut_each(FIELDS, MultiLineString([line((300, 0), (300, 9)), line((310, 0), (310, 9))]))


def test_an_outline_that_asks_for_no_blocks_is_said_to():
    assert "asks for no blocks" in said(guess_each(FIELDS))


def test_areas_and_lines_of_a_file_are_blocks_and_cuts(tmp_path):
    home = write(tmp_path / "home.geojson", [BOXES["west"]], name=["home"])
    halves = [shapely.box(0, 0, 40, 60), shapely.box(40, 0, 80, 60)]
    areas = write(
        tmp_path / "blocks.gpkg", halves, name=["close", "wide"],
        row_bearing_deg=[0.0, 90.0], row_spacing_m=[2.0, 5.0], plant_spacing_m=[1.0, 4.0],
    )  # fmt: skip
    made = prepare(PlotRequest(PlotSources(home, blocks=areas)))
    assert made.plot.grid.n_blocks == 2
    assert made.assumed == ()
    assert "Rows run in 2 blocks as drawn: close, wide." in sentences(made)
    block_of = block_number(made.plot.grid)
    assert np.count_nonzero(block_of == 1) > 5 * np.count_nonzero(block_of == 2)
    cuts = write(tmp_path / "cut.geojson", [LineString([(40, -5), (45, 65)])])
    made = prepare(PlotRequest(PlotSources(home, blocks=cuts)))
    assert made.plot.grid.n_blocks == 2
    assert "1 line parts the plot into 2 blocks." in sentences(made)


def test_a_column_tells_the_blocks_of_each_plot(tmp_path):
    shapes = [shapely.box(x, 0, x + 40, 60) for x in (0, 40, 100, 140)]
    path = write(
        tmp_path / "estate.gpkg", shapes, name=["west", "west", "east", "east"],
        part=["a", "b", "a", "b"], row_bearing_deg=[0.0, 90.0, 45.0, 10.0],
    )  # fmt: skip
    options = PlotOptions().naming(block="part")
    estate = prepare_estate(PlotRequest(PlotSources(path, options)))
    assert [field.name for field in estate.fields] == ["west", "east"]
    assert [[b.name for b in field.blocks] for field in estate.fields] == [["a", "b"], ["a", "b"]]
    assert [b.row_bearing_deg for b in estate.fields[1].blocks] == [45.0, 10.0]
    one = PlotOptions(feature="east").naming(block="part")
    made = prepare(PlotRequest(PlotSources(path, one)))
    assert (made.plot.field.name, made.plot.grid.n_blocks) == ("east", 2)
    assert "4 features are the blocks of 2 plots." in sentences(made)


def test_blocks_are_guessed_only_where_that_is_asked_for(tmp_path):
    shape = shapely.Polygon([(0, 0), (120, 0), (120, 30), (30, 30), (30, 140), (0, 140)])
    home = write(tmp_path / "home.geojson", [shape], name=["home"])
    assert prepare(PlotRequest(PlotSources(home))).plot.grid.n_blocks == 1
    made = prepare(PlotRequest(PlotSources(home, guess_blocks=True)))
    assert made.plot.grid.n_blocks == 2
    assert "2 blocks were guessed from the outline" in sentences(made)
    with pytest.raises(SettingError, match="drawn or guessed"):
        prepare(PlotRequest(PlotSources(home, blocks=home, guess_blocks=True)))


def test_rows_alone_are_a_plot_and_that_is_said(tmp_path):
    lines = [LineString([(0, y), (40, y + 4), (80, y)]) for y in 3.0 * np.arange(8)]
    rows = write(tmp_path / "vines.geojson", lines)
    made = prepare(PlotRequest(PlotSources(rows=rows), PlantingChoices(plant_spacing_m=1.5)))
    assert made.plot.field.name == "vines"
    assert made.plot.grid.n_rows == 8
    assert made.plot.grid.row_spacing_m == pytest.approx(3.0, abs=0.02)
    assert "No boundary was given" in sentences(made)
    assert made.assumed == ()
    alone = write(tmp_path / "one.geojson", lines[:1])
    with pytest.raises(PlotError, match="two or more, but 'one' has 1"):
        prepare(PlotRequest(PlotSources(rows=alone)))
    with pytest.raises(SettingError, match="need the plot"):
        prepare(PlotRequest(PlotSources(rows=rows, contours=rows)))


def test_a_track_along_several_rows_is_no_row_with_a_boundary_or_without(tmp_path):
    ends = [(x, 4.0 * k) for k in range(6) for x in ((0.0, 80.0) if k % 2 else (80.0, 0.0))]
    track = write(tmp_path / "track.geojson", [LineString(ends)])
    plot = write(tmp_path / "plot.geojson", [shapely.box(-5, -5, 85, 25)])
    for sources in (PlotSources(plot=plot, rows=track), PlotSources(rows=track)):
        with pytest.raises(PlotError, match="line 1 of 1 turns back beside itself"):
            prepare(PlotRequest(sources))


def test_plants_name_their_blocks_in_a_column(tmp_path):
    k, j = np.divmod(np.arange(300), 30)
    xy_m = np.concatenate([np.stack([1.5 * j + east, 2.5 * k], 1) for east in (0.0, 60.0)])
    lon, lat = FRAME.lonlat(xy_m).T
    names = ["north"] * 300 + ["south"] * 300
    rows = [f"{a:.9f},{b:.9f},{c}" for a, b, c in zip(lon, lat, names, strict=True)]
    (tmp_path / "vines.csv").write_text("\n".join(["lon,lat,block", *rows]))
    made = prepare(PlotRequest(PlotSources(plants=tmp_path / "vines.csv")))
    assert made.plot.grid.n_blocks == 2
    assert "Column 'block' names the blocks." in sentences(made)


def terrain(path, height_m):
    """Write heights about the frame's middle, of 1 m pixels, as a GeoTIFF."""
    to_utm = Transformer.from_crs("OGC:CRS84", 32632, always_xy=True)
    east, north = np.round(to_utm.transform(FRAME.lon, FRAME.lat))
    x, y = np.meshgrid(east - 149.5 + np.arange(300), north + 149.5 - np.arange(300))
    lon, lat = to_utm.transform(x.ravel(), y.ravel(), direction="INVERSE")
    xy_m = FRAME.xy_m(np.stack([lon, lat], axis=1))
    profile = {"driver": "GTiff", "width": 300, "height": 300, "count": 1, "dtype": "float32"}
    place = from_origin(east - 150, north + 150, 1.0, 1.0)
    with rasterio.open(path, "w", crs=32632, transform=place, **profile) as tif:
        tif.write(height_m(*xy_m.T).reshape(300, 300).astype(np.float32), 1)
    return path


def hill(x, y):
    """Return heights of a cone whose top is 90 m south."""
    return 400.0 - 0.3 * np.hypot(x, y + 90.0)


def fan(x, y):
    """Return heights of a slope that is three times as steep in the east as in the west."""
    return 400.0 + 0.2 * (y + 40.0) * (1.0 + x / 100.0)


def on_terraces(tmp_path, height_m, **more):
    home = write(tmp_path / "home.geojson", [shapely.box(-50, -30, 50, 35)], name=["terrace"])
    sources = PlotSources(home, contours=terrain(tmp_path / "dem.tif", height_m), **more)
    return prepare(PlotRequest(sources, PlantingChoices(row_spacing_m=3.0, plant_spacing_m=1.2)))


def rise_m(grid, height_m):
    """Return how far each row rises from its lowest plant to its highest."""
    height = height_m(*FRAME.xy_m(grid.lonlat()).T)
    return np.array([np.ptp(height[a:b]) for a, b in pairwise(grid.row_start)])


def test_rows_of_a_terrace_follow_the_contours_of_its_raster_a_spacing_apart(tmp_path):
    prepared = on_terraces(tmp_path, hill)
    grid = prepared.plot.grid
    assert grid.n_rows > 15
    # a row of 100 m on a slope of 30 % keeps to its level
    assert rise_m(grid, hill).max() < 0.2
    one = np.repeat(np.arange(len(grid)), np.diff(grid.across_start))
    away_m = np.hypot(*(FRAME.xy_m(grid.lonlat()) + np.array([0.0, 90.0])).T)
    apart_m = np.abs(away_m[one] - away_m[grid.across_plant])
    assert apart_m == pytest.approx(np.full(len(apart_m), 3.0), rel=0.05)
    assert "They rise or fall by 1.0 % at most." in sentences(prepared)
    assert "leave them" not in sentences(prepared)


def test_where_contours_come_nearer_it_is_said_how_steep_rows_get_and_blocks_follow_their_own(
    tmp_path,
):
    whole = on_terraces(tmp_path, fan)
    assert "Contours come nearer to each other or part" in sentences(whole)
    # rows still keep their distance
    grid = whole.plot.grid
    one = np.repeat(np.arange(len(grid)), np.diff(grid.across_start))
    off_m = np.hypot(*(grid.xy_m[one] - grid.xy_m[grid.across_plant]).T)
    assert (off_m > 0.95 * 3.0).all()
    cuts = [shapely.LineString([(-60, -8), (60, -8)]), shapely.LineString([(-60, 14), (60, 14)])]
    parted = on_terraces(tmp_path, fan, blocks=write(tmp_path / "cuts.geojson", cuts))
    assert parted.plot.grid.n_blocks == 3
    assert rise_m(parted.plot.grid, fan).max() < 0.7 * rise_m(grid, fan).max()
    assert "leave them" in sentences(parted)


def test_only_rows_on_the_plot_are_said_to_bear_plants(tmp_path):
    home = write(tmp_path / "home.geojson", [BOXES["west"]], name=["home"])
    rows = write(
        tmp_path / "rows.gpkg", [LineString([(5, y), (75, y + 2)]) for y in range(2, 98, 4)]
    )
    assert "along 14 of the 24 rows that were drawn: the others" in sentences(
        prepare(PlotRequest(PlotSources(home, rows=rows)))
    )
