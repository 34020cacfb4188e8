"""What phones bring has tables of its own; a file made before there were any opens as ever."""

import shutil
import sqlite3
from contextlib import closing

from fieldmon.monitoring import Season, scouts
from fieldmon.monitoring.photos import Photo, keep, photos_of, picture
from fieldmon.monitoring.salvage import salvage
from fieldmon.monitoring.tellings import take
from tests.monitoring.seasons import BEGINS, state
from tests.monitoring.telling import JPEG, NOW, a_telling, told, without_phones


def schema_of(path):
    with closing(sqlite3.connect(path)) as db:
        made = sorted(db.execute("SELECT type, name, sql FROM sqlite_master WHERE sql NOTNULL"))
        told = sorted(db.execute("SELECT table_name, data_type, srs_id FROM gpkg_contents"))
        styled = sorted(db.execute("SELECT f_table_name FROM layer_styles"))
    return made, told, styled


def test_a_file_of_version_4_becomes_what_a_new_one_is(path, tmp_path):
    old = shutil.copy(path, tmp_path / "old.gpkg")
    without_phones(old)
    season = Season(old)
    assert schema_of(old) == schema_of(path)
    assert season.status(BEGINS).found == 3
    take(season, scouts.let_in(season, "Ann"), [a_telling(3)], NOW)
    assert state(old) == 13


def test_what_phones_brought_is_saved_from_a_damaged_file(path, tmp_path):
    season = Season(path)
    key, one = scouts.let_in(season, "Ann"), a_telling(3)
    take(season, key, [one], NOW)
    keep(season, key, Photo("one", one.id, JPEG, NOW))
    assert salvage(path, tmp_path / "rescued.gpkg").whole
    rescued = Season(tmp_path / "rescued.gpkg")
    assert told(rescued) == told(season)
    assert picture(rescued, "one") == ("image/jpeg", JPEG)
    assert [photo.plant for photo in photos_of(rescued)] == [3]
