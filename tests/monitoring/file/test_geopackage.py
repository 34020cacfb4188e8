"""Geometries as GeoPackages hold them, in and out, bit for bit."""

import inspect
import shutil
import sqlite3
import zlib
from contextlib import closing
from dataclasses import replace

import geopandas as gpd
import numpy as np
import pyogrio
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from shapely import LineString, MultiPolygon, Point, box

from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.days.advised import advise
from fieldmon.monitoring.file import geopackage
from fieldmon.monitoring.file.geopackage import (
    GeoPackageTable,
    blob,
    geometry,
    insert,
    point_blobs,
    touch,
    unpacked,
)
from fieldmon.monitoring.phones import photos, scouts
from fieldmon.monitoring.phones.findings import take
from fieldmon.monitoring.phones.photos_asked import ask_no_more, ask_photo
from fieldmon.plot.field import Field
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from tests.monitoring.inspecting.test_drafts import add
from tests.monitoring.phone import JPEG, NOW, a_finding
from tests.monitoring.seasons import BEGINS, ROBOT, on, some_results

TABLE = GeoPackageTable("spots", ("number INTEGER", "name TEXT NOT NULL"), "POINT", "Some spots.")
degrees = st.floats(-180.0, 180.0)


@given(st.integers(0, 20).flatmap(lambda n: arrays(np.float64, (n, 2), elements=degrees)))
def test_points_written_together_are_those_written_one_by_one(lonlat):
    assert point_blobs(lonlat) == [blob(Point(x, y)) for x, y in lonlat.tolist()]


@pytest.mark.parametrize(
    "shape",
    [
        Point(35.15, 30.36),
        LineString([(0, 0), (1.1, 2.2)]),
        MultiPolygon([box(0, 0, 1, 1).difference(box(0.2, 0.2, 0.3, 0.3))]),
        Point(),
        MultiPolygon(),
    ],
    ids=lambda shape: shape.geom_type,
)
def test_a_geometry_comes_back_bit_for_bit_and_says_whether_it_is_empty(shape):
    packed = blob(shape)
    assert shapely.to_wkb(geometry(packed)) == shapely.to_wkb(shape)
    assert (packed[:3], bool(packed[3] & 0x10)) == (b"GP\x00", shape.is_empty)
    assert int.from_bytes(packed[4:8], "little") == 4326


@pytest.mark.parametrize(("code", "length"), [(1, 32), (2, 48), (3, 48), (4, 64)])
def test_geometries_of_other_programs_are_read_whatever_envelope_they_have(code, length):
    packed = b"GP\x00" + bytes([0x01 | code << 1]) + (4326).to_bytes(4, "little")
    shape = LineString([(0, 0), (1, 2)])
    assert geometry(packed + b"\x00" * length + shapely.to_wkb(shape)).equals(shape)


@pytest.fixture
def spots(tmp_path):
    path = tmp_path / "spots.gpkg"
    with closing(sqlite3.connect(path, isolation_level=None)) as db:
        geopackage.found(db)
        geopackage.create(db, TABLE)
        insert(db, TABLE, [(blob(Point(35.0, 30.0)), 7, "a"), (None, 8, "b")])
        touch(db, "spots", (35.0, 30.0, 35.0, 30.0))
    return path


def test_gdal_reads_what_was_written_and_where_it_is(spots):
    frame = pyogrio.read_dataframe(spots, layer="spots")
    assert frame["number"].tolist() == [7, 8]
    assert frame.geometry.iloc[0].equals(Point(35.0, 30.0))
    assert frame.geometry.iloc[1] is None
    assert frame.crs.to_epsg() == 4326
    info = pyogrio.read_info(spots, layer="spots")
    assert info["total_bounds"] == (35.0, 30.0, 35.0, 30.0)


def test_a_table_names_its_geometry_first():
    assert TABLE.names == ("geom", "number", "name")
    assert GeoPackageTable("notes", ("text TEXT",), None, "Notes.").names == ("text",)


# --- programs draw a layer anew only if the contents say that it changed --------------------------


def _look(season):
    take(season, scouts.let_in(season, "Ann"), [a_finding(30, FOUND, lonlat=(35.15, 30.36))], NOW)


def _take_back(season):
    key, told = scouts.let_in(season, "Ann"), a_finding(30)
    take(season, key, [told], NOW)
    yield
    take(season, key, [a_finding(None, None, undoes=told.id)], NOW)


def _photograph(season):
    key, told = scouts.let_in(season, "Ann"), a_finding(30)
    take(season, key, [told], NOW)
    yield
    photos.keep(season, key, photos.Photo("one", told.id, JPEG, NOW))


def _undo_photographed(season):
    for _ in _photograph(season):
        pass
    yield
    season.undo()


def _ask_no_more(season):
    ask_photo(season, 30, name="mine")
    yield
    ask_no_more(season, "mine")


def _undo_treatment(season):
    season.treat(BEGINS, 0.8)
    yield
    season.undo()


def _take_back_key(season):
    scouts.let_in(season, "Ann")
    yield
    scouts.withdraw_key(season, "Ann")


def _draft(season):
    add(season.path)
    yield
    Season(season.path)


def _merge(season):
    other = Season(shutil.copy(season.path, season.path.with_name("other.gpkg")))
    other.record(some_results(other, day=2, found=[1]), "wednesday.csv", "Ben")
    other.plan(on(3))
    other.treat(on(2), 0.5)
    yield
    season.merge(other)


WORK = {
    "plan": lambda season: season.plan(on(1)),
    "record": lambda season: season.record(some_results(season, day=1, found=[0, 1]), "x", "Ann"),
    "undo": lambda season: season.undo(),
    "undo one": lambda season: season.undo(inspection=3),
    "treat": lambda season: season.treat(BEGINS, 0.8, product="soap"),
    "undo a treatment": _undo_treatment,
    "labels": lambda season: season.keep_labels([ProductLabel("soap", waiting_days=3)]),
    "settings": lambda season: season.change(
        replace(season.settings, sampler="naive"), season.settings
    ),
    "advise": lambda season: advise(season, BEGINS, "Inspect more."),
    "let in": lambda season: scouts.let_in(season, "Ann"),
    "take a key back": _take_back_key,
    "tell": _look,
    "take back": _take_back,
    "photo": _photograph,
    "undo what has a photo": _undo_photographed,
    "ask": lambda season: ask_photo(season, 30),
    "ask no more": _ask_no_more,
    "draft": _draft,
    "merge": _merge,
}
#: what no program shows
INNER = {
    *("fieldmon", "batches", "settings", "arrays", "mornings", "inspection_lots", "log"),
    *("learnt", "scouts", "labels", "import_findings", "outside_changes"),
}


def _told(db):
    """Return what stands in each layer and table of the contents, and when it says it changed."""
    changed = dict(db.execute("SELECT table_name, last_change FROM gpkg_contents"))
    rows = {
        name: db.execute(f"SELECT * FROM {name}").fetchall()  # noqa: S608 - a name of ours
        for name in changed.keys() - INNER
    }
    return rows, changed


@pytest.mark.parametrize("work", WORK.values(), ids=WORK)
def test_a_layer_that_a_piece_of_work_changed_says_so_and_holds_what_it_shows(path, work):
    season = Season(path)
    made = work if inspect.isgeneratorfunction(work) else None
    steps = made(season) if made else iter(())
    next(steps, None)
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE gpkg_contents SET last_change = '2000-01-01T00:00:00.000Z'")
        db.commit()
        before, _ = _told(db)
    assert next(steps, None) is None
    if made is None:
        work(season)
    with closing(sqlite3.connect(path)) as db:
        after, changed = _told(db)
        boxes = db.execute(
            "SELECT c.table_name, min_x, min_y, max_x, max_y FROM gpkg_contents c "
            "JOIN gpkg_geometry_columns USING (table_name) WHERE min_x NOTNULL"
        ).fetchall()
        for name, *box_of in boxes:
            wanted = f"SELECT geom FROM {name} WHERE geom NOTNULL"  # noqa: S608 - as above
            shapes = [geometry(one) for (one,) in db.execute(wanted)]
            if name in ("treatments", "plots", "hot_spots") or not shapes:
                continue
            whole = shapely.box(*box_of).buffer(1e-4)
            assert shapely.contains(whole, shapes).all(), name
    silent = {name for name in after if before[name] != after[name] and changed[name] < "2001"}
    assert silent == set()


@given(st.binary(max_size=50))
def test_what_is_packed_unpacks_to_no_more_than_may_be_and_never_in_part(data):
    packed = zlib.compress(data)
    assert unpacked(packed, len(data)) == unpacked(packed, 1000) == data
    for one, most in ((packed, len(data) - 1), (packed[:-1], 1000), (b"x" + packed, 1000)):
        with pytest.raises(sqlite3.DatabaseError, match="what is packed"):
            unpacked(one, most)


def test_all_layers_of_a_plot_across_longitude_180_lie_in_one_piece(tmp_path):
    """As the plot itself, given from 0 to 360: else half lies at the other end of the world."""
    area = MultiPolygon([box(179.9996, -16.8005, 180.0004, -16.8)])
    season = Season.create(
        tmp_path / "taveuni.gpkg",
        Plot.of(Field("Taveuni", area, gate=(179.9996, -16.8)), Planting()),
        begins=BEGINS,
        robot=ROBOT,
    )
    season.plan(BEGINS)
    near = np.flatnonzero(season.plot.grid.lonlat()[:, 0] < 0)[0]
    day = np.datetime64(BEGINS, "D")
    plants = np.array([0, near, near + 1])
    season.record(Inspections.of(plants, np.array([CLEAN, FOUND, FOUND]), day), "x")
    layers = pyogrio.list_layers(season.path)[:, 0].tolist()
    for layer in ("plots", "plants", "rows", "chance", "inspections", "routes", "stops"):
        assert layer in layers
        west, _, east, _ = gpd.read_file(season.path, layer=layer).total_bounds
        assert 179.9995 < west < east < 180.0005, layer
    with season.store.reading() as db:
        said = db.execute(
            "SELECT min_x, max_x FROM gpkg_contents WHERE min_x IS NOT NULL"
        ).fetchall()
    assert all(179.9995 < west < east < 180.0005 for west, east in said)
    assert len(said) >= 6
    again = Season(season.path)
    assert again.verify() == ()
    assert again.history.inspections.plant.tolist() == plants.tolist()
    assert (again.plot.grid.lonlat() == season.plot.grid.lonlat()).all()
