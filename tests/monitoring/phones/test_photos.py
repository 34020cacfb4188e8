"""Photos are kept byte for byte, once, and other programs find them with their plants."""

import base64
import os
import sqlite3
import subprocess
from contextlib import closing

import pyogrio
import pytest

from fieldmon.errors import AccessError, LimitError, ObservationError
from fieldmon.infestation.inspections import FOUND
from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import photos, scouts
from fieldmon.monitoring.phones.findings import take
from fieldmon.monitoring.phones.photos import Photo, keep, photos_of, picture
from fieldmon.monitoring.phones.photos_asked import ask_photo
from tests.monitoring.phone import JPEG, NOW, a_finding


@pytest.fixture
def season(path):
    return Season(path)


@pytest.fixture
def key(season):
    return scouts.let_in(season, "Ann")


def a_photo(finding, name="one", data=JPEG):
    return Photo(name, finding, data, NOW, (35.1501, 30.3601), 4.0)


def test_a_photo_is_kept_once_byte_for_byte_and_gdal_finds_it_at_its_plant(season, key):
    one = a_finding(3, FOUND)
    take(season, key, [one], NOW)
    assert keep(season, key, a_photo(one.id))
    assert not keep(season, key, a_photo(one.id))
    assert picture(season, "one") == ("image/jpeg", JPEG)
    assert picture(season, "two") is None
    assert [(photo.id, photo.plant, photo.scout) for photo in photos_of(season)] == [
        ("one", 3, "Ann")
    ]
    places = pyogrio.read_dataframe(season.path, layer="photo_places")
    assert places.plant.tolist() == [3]
    assert bytes(places.data[0]) == JPEG
    assert abs(places.get_coordinates().to_numpy() - season.plot.grid.lonlat([3])).max() < 1e-9
    are_related_as_the_standard_asks(season)


def are_related_as_the_standard_asks(season):
    """OGC 18-000, clauses 7.2 to 7.4: relations, extensions, mapping and media tables."""
    with closing(sqlite3.connect(season.path)) as db:
        (relation,) = db.execute(
            "SELECT base_table_name, base_primary_column, related_table_name, "
            "related_primary_column, relation_name, mapping_table_name FROM gpkgext_relations"
        )
        assert relation == ("inspections", "fid", "photos", "id", "media", "inspections_photos")
        told = db.execute(
            "SELECT table_name, column_name, extension_name, scope FROM gpkg_extensions"
        )
        assert sorted(told) == [
            (name, None, "gpkg_related_tables", "read-write")
            for name in ("gpkgext_relations", "inspections_photos")
        ]
        kinds = dict(db.execute("SELECT table_name, data_type FROM gpkg_contents"))
        assert kinds["photos"] == kinds["inspections_photos"] == "attributes"
        columns = {row[1]: (row[2], row[5]) for row in db.execute("PRAGMA table_info(photos)")}
        assert columns["id"] == ("INTEGER", 1)
        assert (columns["data"][0], columns["content_type"][0]) == ("BLOB", "TEXT")
        (pair,) = db.execute("SELECT base_id, related_id FROM inspections_photos")
        there = db.execute(
            "SELECT i.plant, p.photo FROM inspections i, photos p WHERE i.fid = ? AND p.id = ?",
            pair,
        )
        assert there.fetchone() == (3, "one")


def test_a_photo_may_come_before_what_it_belongs_to(season, key):
    one = a_finding(3, FOUND)
    keep(season, key, a_photo(one.id))
    assert photos_of(season) == ()
    take(season, key, [one], NOW)
    assert [photo.plant for photo in photos_of(season)] == [3]


@pytest.mark.parametrize(
    ("data", "error", "why"),
    [
        (b"GIF89a", ObservationError, "JPEG, PNG or WebP"),
        (b"RIFF0000AVI ", ObservationError, "JPEG, PNG or WebP"),
        (b"", ObservationError, "JPEG, PNG or WebP"),
        (b"\xff\xd8\xff" + bytes(photos.MOST_BYTES), LimitError, "4 MB at most"),
    ],
)
def test_what_is_no_photo_is_refused(season, key, data, error, why):
    with pytest.raises(error, match=why):
        keep(season, key, a_photo("x", data=data))


def test_another_photo_does_not_replace_one_with_its_id(season, key):
    keep(season, key, a_photo("x"))
    with pytest.raises(ObservationError, match="id of its own"):
        keep(season, key, a_photo("x", data=JPEG + b"!"))
    assert picture(season, "one") == ("image/jpeg", JPEG)


def test_photos_have_a_limit_in_number_and_need_a_key(season, key, monkeypatch):
    monkeypatch.setattr(photos, "MOST_A_DAY", 1)
    keep(season, key, a_photo("x"))
    with pytest.raises(LimitError, match="1 photos a day"):
        keep(season, key, a_photo("x", "two"))
    scouts.withdraw_key(season, "Ann")
    with pytest.raises(AccessError):
        keep(season, key, a_photo("x", "three"))


_ASK_QGIS = """
import base64, sys
from qgis.core import QgsApplication, QgsProject
app = QgsApplication([], False)
app.initQgis()
project = QgsProject.instance()
assert project.read(f"geopackage:{sys.argv[1]}?projectName=fieldmon")
(photos,) = project.mapLayersByName("Photos")
(asked,) = project.mapLayersByName("Photos asked for")
places = list(photos.getFeatures())
print(photos.isValid(), asked.isValid(), len(places), asked.featureCount(), places[0]["plant"],
      "to_base64" in photos.mapTipTemplate())
print(base64.b64encode(bytes(places[0]["data"])).decode(), flush=True)
del places, photos, asked
project.clear()
app.exitQgis()
"""


@pytest.mark.skipif(not os.path.isdir("/usr/lib/python3/dist-packages/qgis"),  # noqa: PTH112
                    reason="QGIS (Debian's python3-qgis) is not on this machine")  # fmt: skip
def test_qgis_opens_the_season_and_shows_the_photo_at_its_plant(season, key, tmp_path):
    one = a_finding(3, FOUND)
    take(season, key, [one], NOW)
    keep(season, key, a_photo(one.id))
    ask_photo(season, 5, "the lower leaves", "Office")
    season.rebuild()
    asked = subprocess.run(
        ["/usr/bin/python3", "-c", _ASK_QGIS, str(season.path)],
        check=False, capture_output=True, text=True,
        env={"QT_QPA_PLATFORM": "offscreen", "HOME": str(tmp_path), "PATH": os.environ["PATH"]},
    )  # fmt: skip
    assert asked.returncode == 0, asked.stderr
    told, photo = asked.stdout.splitlines()[-2:]
    assert told == "True True 1 1 3 True"
    assert base64.b64decode(photo) == JPEG
