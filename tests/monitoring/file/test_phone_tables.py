"""What phones bring has tables of its own; a file made before there were any opens as ever."""

import shutil
import sqlite3
from contextlib import closing

from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.phones.findings import take
from fieldmon.monitoring.phones.photos import Photo, keep, photos_of, picture
from fieldmon.monitoring.season.salvage import salvage
from tests.monitoring.phone import JPEG, NOW, a_finding, told, without_phones
from tests.monitoring.rules import keeps_the_rules
from tests.monitoring.seasons import BEGINS, state


def schema_of(path):
    with closing(sqlite3.connect(path)) as db:
        made = sorted(db.execute("SELECT type, name, sql FROM sqlite_master WHERE sql NOTNULL"))
        told = sorted(db.execute("SELECT table_name, data_type, srs_id FROM gpkg_contents"))
        styled = sorted(db.execute("SELECT f_table_name FROM layer_styles"))
    return made, told, styled


def test_a_file_of_version_5_becomes_what_a_new_one_is(path, tmp_path):
    old = shutil.copy(path, tmp_path / "old.gpkg")
    without_phones(old)
    season = Season(old)
    assert schema_of(old) == schema_of(path)
    assert season.status(BEGINS).found == 3
    take(season, scouts.let_in(season, "Ann"), [a_finding(3)], NOW)
    assert state(old) == 13


def test_what_phones_brought_is_saved_from_a_damaged_file(path, tmp_path):
    season = Season(path)
    key, one = scouts.let_in(season, "Ann"), a_finding(3)
    take(season, key, [one], NOW)
    keep(season, key, Photo("one", one.id, JPEG, NOW))
    assert salvage(path, tmp_path / "rescued.gpkg").whole
    rescued = Season(tmp_path / "rescued.gpkg")
    assert told(rescued) == told(season)
    assert picture(rescued, "one") == ("image/jpeg", JPEG)
    assert [photo.plant for photo in photos_of(rescued)] == [3]


def test_what_phones_brought_to_two_copies_is_in_the_merged_one_once_each(path, tmp_path):
    here = Season(path)
    ann = scouts.let_in(here, "Ann")
    both, taken_back = a_finding(30), a_finding(31)
    take(here, ann, [both, taken_back], NOW)
    there = Season(shutil.copy(path, tmp_path / "season.gpkg.copy"))
    ben = scouts.let_in(here, "Ben")
    one = a_finding(32, 1)
    take(here, ben, [one], NOW)
    keep(here, ben, Photo("one", one.id, JPEG, NOW))
    with there.store.writing() as db:  # a copy knows no key of another file
        db.execute("UPDATE scouts SET ended = '2026-04-06'")
    cem = scouts.let_in(there, "Ann")
    other = a_finding(33, 1)
    take(there, cem, [other, a_finding(None, None, undoes=taken_back.id)], NOW)
    keep(there, cem, Photo("two", other.id, JPEG + b"2", NOW))
    here.merge(there)
    ids, rows = told(here)
    assert len(ids) == len(set(ids)) == 5
    assert sorted(row[1] for row in rows) == [30, 32, 33]
    assert {photo.plant: picture(here, photo.id)[1] for photo in photos_of(here)} == {
        32: JPEG, 33: JPEG + b"2"
    }  # fmt: skip
    assert [scout.name for scout in scouts.scouts_of(here)].count("Ben") == 1
    assert here.verify() == ()
    keeps_the_rules(path)
