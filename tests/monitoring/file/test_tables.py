"""What a season's file holds comes back bit for bit."""

import re
import sqlite3
import tracemalloc
import zlib
from contextlib import closing
from dataclasses import fields, replace

import numpy as np
import pyogrio
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from pyproj import Geod
from shapely import MultiLineString, MultiPolygon, box

from fieldmon.errors import FileProblem
from fieldmon.infestation.records import Records
from fieldmon.io.import_report import Remedy, guessed, seen
from fieldmon.monitoring import Season
from fieldmon.monitoring.file import tables
from fieldmon.monitoring.file.tables import KeptMessage
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.block import Block
from fieldmon.plot.clear_lanes import clear_lanes
from fieldmon.plot.field import Field
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from tests.monitoring.seasons import a_plot


def test_a_season_and_its_copy_have_one_plot_and_one_whose_plot_is_another_has_that(path, other):
    plot = Season(path).plot
    assert Season(other).plot is plot
    stated = zlib.compress(np.array([7.0, np.nan, np.nan]).tobytes(), 1)
    with closing(sqlite3.connect(other)) as db:
        db.execute("UPDATE plots SET name = 'Elsewhere'")
        db.commit()
        assert Season(other).plot.field.name == "Elsewhere"
        db.execute("UPDATE arrays SET data = ? WHERE name = 'stated'", (stated,))
        db.commit()
        assert Season(other).plot.field.row_bearing_deg == 7.0
    assert Season(path).plot.field.name == plot.field.name


@pytest.mark.parametrize(
    "lost",
    [
        "DELETE FROM arrays",
        "DELETE FROM arrays WHERE name = 'grid.xy_m'",
        "DELETE FROM arrays WHERE name = 'stated'",
        "DELETE FROM plots",
    ],
)
def test_a_season_whose_plants_are_lost_says_so_without_a_word_of_python(path, lost):
    with closing(sqlite3.connect(path)) as db:
        db.execute("DROP TRIGGER IF EXISTS changed_outside_plots")
        db.execute(lost)
        db.commit()
    with pytest.raises(FileProblem, match="not all that says where they stand") as problem:
        Season(path)
    assert re.search(r"__|None|'|argument", str(problem.value).replace("season's", "")) is None


def test_an_array_that_unpacks_to_more_than_it_says_is_refused_and_not_unpacked(path):
    with closing(sqlite3.connect(path)) as db:
        bomb = zlib.compress(bytes(300_000_000), 9)
        db.execute("UPDATE arrays SET data = ? WHERE name = 'stated'", (bomb,))
        db.commit()
    del bomb
    tracemalloc.start()
    with pytest.raises(FileProblem, match=r"is damaged \(.*more than 24 bytes"):
        Season(path)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 100e6


def test_all_arrays_together_unpack_to_a_limit(db, monkeypatch):
    monkeypatch.setattr(tables, "_MOST_BYTES", 1000)
    for name in "abc":
        tables.write_array(db, name, np.zeros(50))
    assert len(tables.read_arrays(db, "a")) == 1
    with pytest.raises(sqlite3.DatabaseError, match="more than 200 bytes"):
        tables.read_arrays(db)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    arrays(
        st.sampled_from((np.float64, np.int32, np.int8, np.bool_)),
        array_shapes(min_dims=1, max_dims=3, min_side=0),
    )
)
def test_an_array_comes_back_with_its_type_and_its_shape(db, values):
    db.execute("DELETE FROM arrays")
    tables.write_array(db, "some.values", values)
    again = tables.read_arrays(db, "some.%")["some.values"]
    assert (again.dtype, again.shape) == (values.dtype, values.shape)
    assert again.tobytes() == values.tobytes()


def test_arrays_are_asked_for_by_the_beginning_of_their_names(db):
    for name in ("grid.a", "grid.b", "risk"):
        tables.write_array(db, name, np.arange(3))
    assert sorted(tables.read_arrays(db, "grid.%")) == ["grid.a", "grid.b"]
    assert tables.read_arrays(db, "none") == {}


def full_field():
    boundary = MultiPolygon([box(35.15, 30.36, 35.1508, 30.3607)])
    measured = a_plot().grid.lonlat()[::3].copy()
    return Field(
        "מטע",
        boundary,
        no_go=MultiPolygon([box(35.1502, 30.3602, 35.15025, 30.36025)]),
        gate=(35.15, 30.36),
        paths=MultiLineString([[(35.15, 30.36), (35.1508, 30.36)]]),
        plants=measured,
        row_bearing_deg=12.5,
        row_spacing_m=4.0,
    )


@pytest.mark.parametrize("faces", [1, 2])
def test_a_plot_comes_back_exactly_as_it_was_laid(db, faces):
    by_hand = Planting(row_bearing_deg=12.5, row_spacing_m=4.0, faces=faces, headland_m=3.0)
    plot = Plot.of(full_field(), by_hand)
    taken = Assumed("plant_spacing_m", 3.0), Assumed("row_bearing_deg", 72.3)
    plot = replace(plot, assumed=taken[:faces])
    check_comes_back(db, plot)


def test_a_plot_comes_back_with_where_one_may_drive_beyond_its_boundary(db):
    plot = a_plot()
    beyond_m = MultiPolygon([box(-9, -9, -5, 9)])
    grid = replace(plot.grid, beyond_m=beyond_m)
    check_comes_back(db, replace(plot, aisles=replace(plot.aisles, grid=grid)))


def test_a_plot_comes_back_with_the_pieces_of_rows_whose_lanes_are_cut(db):
    shed = box(35.1504, 30.36032, 35.15045, 30.36034)
    cut = clear_lanes(a_plot().grid, a_plot().grid.frame.geometry_m(shed)).grid
    assert cut.cut_ends.any()
    check_comes_back(db, replace(a_plot(), aisles=replace(a_plot().aisles, grid=cut)))
    (rows,) = db.execute("SELECT count(*) FROM rows").fetchone()
    assert rows == a_plot().grid.n_rows


def test_a_plot_comes_back_with_its_blocks_and_the_names_of_its_rows(db):
    field = replace(full_field(), plants=None, row_bearing_deg=None)
    west, east = box(35.15, 30.36, 35.1503, 30.3607), box(35.1503, 30.36, 35.1508, 30.3607)
    blocks = (
        Block("hill", MultiPolygon([west]), 10.0, 4.0, 2.0),
        Block("", MultiPolygon([east]), plant_spacing_m=1.5),
    )
    check_comes_back(db, Plot.of(replace(field, blocks=blocks)))
    kinds = db.execute("SELECT kind FROM places").fetchall()
    assert sum(kind == "block" for (kind,) in kinds) == 2


def test_measured_plants_come_back_with_their_names_and_those_of_their_rows_and_blocks(db):
    grid = Plot.of(replace(full_field(), plants=None)).grid
    line = grid.row_line[grid.row]
    names = (line.max() + 7 - line).astype(np.str_)
    field = replace(
        full_field(),
        plants=grid.lonlat(),
        plant_rows=names,
        plant_blocks=np.full(len(grid), "home"),
        plant_names=np.array([f"vine {k + 1}" for k in range(len(grid))]),
    )
    check_comes_back(db, Plot.of(field))
    for table in ("rows", "plants"):
        lines = db.execute(f"SELECT line FROM {table} ORDER BY fid").fetchall()  # noqa: S608
        assert lines[0] == (line.max() + 7,)
    assert db.execute("SELECT number FROM plants ORDER BY fid").fetchall()[-1] == (len(grid),)


def check_comes_back(db, plot):
    tables.write_plot(db, plot)
    again = tables.read_plot(db)
    assert (again.assumed, again.headland_m) == (plot.assumed, plot.headland_m)
    assert [block.content for block in again.field.blocks] == [
        block.content for block in plot.field.blocks
    ]
    for name in (each.name for each in fields(plot.grid)):
        value, other = getattr(plot.grid, name), getattr(again.grid, name)
        same = np.array_equal(value, other) if isinstance(value, np.ndarray) else value == other
        assert same, name
    for name in {each.name for each in fields(plot.field)} - {"blocks"}:
        value, other = getattr(plot.field, name), getattr(again.field, name)
        same = np.array_equal(value, other) if isinstance(value, np.ndarray) else value == other
        assert same, name
    assert np.array_equal(again.aisles.travel.between_m, plot.aisles.travel.between_m)


def test_plants_that_cannot_be_read_are_a_sentence(db):
    tables.write_plot(db, a_plot())
    db.execute("DELETE FROM arrays WHERE name = 'grid.xy_m'")
    with pytest.raises(FileProblem, match="fieldmon salvage"):
        tables.read_plot(db)


def test_records_come_back_with_what_is_unknown(db):
    records = Records.of(
        [[35.0, 30.0], [35.1, 30.1]],
        [1, -1],
        np.array(["2026-03-30", "NaT"], "datetime64[D]"),
        count=np.array([4.0, np.nan]),
        species=np.array(["Tetranychus urticae", ""]),
    )
    tables.write_records(db, records)
    again = tables.read_records(db)
    for name, values in vars(records).items():
        np.testing.assert_array_equal(getattr(again, name), values, err_msg=name)


def test_without_records_there_are_none(db):
    tables.write_records(db, Records.none())
    assert len(tables.read_records(db)) == 0


def test_what_imports_had_to_say_is_kept_with_its_source_and_its_way_out(db):
    remedy = Remedy("date_order", "mdy", "Read month first")
    said = [guessed("Dates could be either.", "row 3", remedy), seen("All was well.")]
    kept = tuple(KeptMessage.of("mites.csv", message) for message in said)
    tables.write_messages(db, kept)
    assert tables.read_messages(db) == kept
    assert kept[0] == KeptMessage(
        "mites.csv", "guessed", "row 3", "Dates could be either.", "date_order=mdy"
    )
    assert kept[1].remedy is None


def test_a_gis_sees_boundary_places_rows_and_plants_where_and_as_many_as_they_are(tmp_path):
    field = replace(full_field(), plants=None)
    plot = Plot.of(field, Planting(row_bearing_deg=12.5, row_spacing_m=4.0))
    season = Season.create(tmp_path / "season.gpkg", plot, begins="2026-04-06")
    read = {name: pyogrio.read_dataframe(season.path, layer=name) for name in
            ("plots", "places", "rows", "plants")}  # fmt: skip
    (boundary,) = read["plots"].to_dict("records")
    assert boundary.pop("geometry").equals(field.boundary)
    area_m2, _ = Geod(ellps="WGS84").geometry_area_perimeter(
        shapely.orient_polygons(field.boundary)
    )
    assert boundary.pop("area_ha") == pytest.approx(area_m2 / 1e4, rel=1e-4, abs=1e-4)
    assert boundary == {"name": field.name, "plants": len(plot.grid)}
    places = dict(zip(read["places"]["kind"], read["places"].geometry, strict=True))
    assert places.keys() == {"no-go", "path", "row line", "gate"} & places.keys()
    assert (places["gate"].x, places["gate"].y) == field.gate
    for kind, shape in (("no-go", field.no_go), ("path", field.paths),
                        ("row line", field.row_lines)):  # fmt: skip
        assert (kind in places) == (not shape.is_empty)
        assert kind not in places or places[kind].equals(shape)
    numbered = plant_numbers(plot.grid)
    plants = read["plants"]
    assert plants["plant"].tolist() == list(range(len(plot.grid)))
    assert plants["line"].tolist() == numbered.line.tolist()
    assert plants["number"].tolist() == numbered.number.tolist()
    assert plants.get_coordinates().to_numpy() == pytest.approx(plot.grid.lonlat())
    rows = read["rows"]
    of_row = np.bincount(plot.grid.row)
    assert rows["plants"].tolist() == of_row.tolist()
    lines = plot.grid.row_line + 1
    assert rows["line"].tolist() == lines.tolist()
    for row, shape in enumerate(rows.geometry):
        own = shapely.points(plants.get_coordinates().to_numpy()[plot.grid.row == row])
        assert shapely.distance(shape, own).max() < 1e-7
    with season.store.reading() as db:
        extents = db.execute(
            "SELECT table_name, min_x, min_y, max_x, max_y FROM gpkg_contents "
            "WHERE table_name IN ('plots', 'plants', 'rows', 'chance')"
        ).fetchall()
    for name, *box_of in extents:
        shapes = field.boundary if name == "plots" else plants.geometry
        assert box_of == pytest.approx(shapely.total_bounds(shapes))


@pytest.mark.parametrize("missing", range(1, 6))
def test_a_record_comes_back_with_whatever_of_it_is_known(db, missing):
    rng = np.random.default_rng(missing)
    n = 6
    known = {
        name: np.where(rng.random(n) < 0.5, np.nan, rng.random(n))
        for name in ("count", "accuracy_m", "leaves_sampled")
    }
    days = np.where(rng.random(n) < 0.5, np.datetime64("NaT", "D"), np.datetime64("2026-03-01"))
    made = Records.of(
        rng.random((n, 2)), rng.integers(-1, 2, n).astype(np.int8), days,
        species=np.array(["", "mite", "", "x", "y", "z"]),
        stage=np.array(["egg", "", "", "x", "y", "z"]), **known,
    )  # fmt: skip
    tables.write_records(db, made)
    again = tables.read_records(db)
    for each in fields(made):
        np.testing.assert_array_equal(getattr(again, each.name), getattr(made, each.name))
    (extent,) = db.execute(
        "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'observations'"
    ).fetchall()
    assert list(extent) == [*made.lonlat.min(axis=0), *made.lonlat.max(axis=0)]
