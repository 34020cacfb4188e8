"""What a session brought is found again after a reload, by whoever has the address."""

import getpass
import os
import shutil
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from app.state import kept_files
from app.words import texts
from tests.app.driving import (
    go,
    metric,
    opened,
    plot_name,
    press,
    row_box,
    square,
    texts_of,
    upload,
    word_of,
    zipped,
)

MITES = b"lon,lat,date,count\n35.1505,30.3605,2026-11-10,4\n"


def reloaded(app):
    """Return a new session at the address at which this one stands."""
    return opened(texts.UPLOAD, files=word_of(app))


@pytest.fixture
def brought(app, tmp_path):
    data = zipped(tmp_path, square(name="mine").to_crs(2039), without=".prj")
    upload(app, plot=("plot.zip", data), record=("mites.csv", MITES))
    ask = next(box for box in app.selectbox if box.key.startswith("ask "))
    ask.set_value("EPSG:2039").run()
    press(app, "Use this")
    assert plot_name(app).startswith("mine")
    return app


def test_files_are_found_by_whoever_has_the_whole_address_and_nobody_takes_them_out(brought):
    (kept,) = kept_files.folder().iterdir()
    assert len(list(kept.iterdir())) == 3
    phone = reloaded(brought)
    assert word_of(phone) == kept.name, "the same address, as long as nothing was changed"
    # what a phone takes out is gone there alone
    go(phone, "plot").button(key="forget record").click().run()
    own = kept_files.folder() / word_of(phone)
    assert len(list(own.iterdir())) == 2
    row_box(phone, "row_spacing").set_value(7.0).run()
    office = go(reloaded(brought), "plot")
    assert "1 of 1 records shown" in texts_of(office)
    assert row_box(office, "row_spacing").value != 7.0
    phone.button(key="forget plot").click().run()
    assert not own.exists()
    assert "files" not in phone.query_params
    assert len(list(kept.iterdir())) == 3
    word = kept.name
    assert len(word) == 22
    for guess in ("", word[:-1], f"../{word}", "x" * 22, f"{word}/.."):
        assert "Bring a plot" in texts_of(opened(texts.UPLOAD, files=guess))
    # a reload finds files, answers, rows and what was drawn
    row_box(brought, "row_spacing").set_value(7.0).run()
    brought.selectbox(key="draw_kind").set_value("gate").run()
    brought.text_input(key="draw_typed").set_value("35.1501,30.3601").run()
    press(brought, "Add")
    brought.run()
    plants = metric(brought, "Plants")
    again = go(reloaded(brought), "plot")
    assert not again.exception
    assert plot_name(again).startswith("mine")
    assert metric(again, "Plants") == plants
    assert "1 of 1 records shown" in texts_of(again)
    assert "In use" in texts_of(again)
    assert "the gate: 1" in texts_of(again)


def test_what_nobody_came_back_to_for_a_day_is_removed():
    old, new = kept_files.folder() / ("a" * 22), kept_files.folder() / ("b" * 22)
    old.mkdir()
    new.mkdir()
    long_ago = time.time() - kept_files.KEEP_S - 60
    os.utime(old, (long_ago, long_ago))
    kept_files.clean(time.time())
    assert not old.exists()
    assert new.exists()


@pytest.fixture
def parent(tmp_path, monkeypatch):
    """Give a folder of temporary files of its own, and the name that is known in advance."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path, tmp_path / f"fieldmon-files-{getpass.getuser()}"


def test_what_a_link_in_the_folders_place_leads_to_stays(parent):
    shared, known = parent
    home = shared / "home"
    old = home / ("a" * 22)
    old.mkdir(parents=True)
    home.chmod(0o700)
    long_ago = time.time() - kept_files.KEEP_S - 60
    os.utime(old, (long_ago, long_ago))
    known.symlink_to(home)
    kept_files.clean(time.time())
    kept_files.written("ground-x", "map.mbtiles", b"tiles")
    assert list(home.iterdir()) == [old]
    assert kept_files.folder().stat().st_mode & 0o077 == 0
    assert kept_files.folder() == kept_files.folder(), "found again, also after a restart"


@pytest.mark.skipif(os.name != "posix", reason="no modes of this kind")
@pytest.mark.parametrize("made", ["open", "file", "another's", "another's, both"])
def test_a_folder_that_others_may_write_to_or_own_is_not_used(parent, made, monkeypatch):
    _, known = parent
    others = []
    if made == "file":
        known.touch()
        others = [known]
    elif made == "open":
        known.mkdir()
        known.chmod(0o777)
        others = [known]
    else:
        others = [known, Path(f"{known}-x")][: 1 + made.endswith("both")]
        for one in others:
            one.mkdir(mode=0o700)
        inodes, lstat = {one.lstat().st_ino for one in others}, Path.lstat

        def seen(path):
            found = lstat(path)
            owner = os.getuid() + (found.st_ino in inodes)
            return SimpleNamespace(st_mode=found.st_mode, st_uid=owner)

        monkeypatch.setattr(Path, "lstat", seen)
    assert kept_files.folder() not in others
    assert kept_files.folder().is_dir()


def test_what_was_not_made_here_stays_in_the_folder(parent):  # noqa: ARG001 - the place
    long_ago = time.time() - kept_files.KEEP_S - 60
    kept_files.written("ground-x", "map.mbtiles", b"tiles")
    for name in ("Documents", ".ssh", "ground-x"):
        (kept_files.folder() / name).mkdir(exist_ok=True)
        os.utime(kept_files.folder() / name, (long_ago, long_ago))
    kept_files.clean(time.time())
    assert {one.name for one in kept_files.folder().iterdir()} == {"Documents", ".ssh"}


def test_half_a_folder_is_none(brought):
    (kept,) = kept_files.folder().iterdir()
    for part in kept.glob("*-0"):
        part.unlink()
    again = reloaded(brought)
    assert not again.exception
    assert "Bring a plot" in texts_of(again)
    shutil.rmtree(kept)
    assert "Bring a plot" in texts_of(reloaded(brought))


@pytest.mark.skipif(os.name != "posix", reason="no modes of this kind")
@pytest.mark.usefixtures("brought")
def test_nobody_else_on_the_machine_can_read_them():
    assert kept_files.folder().stat().st_mode & 0o077 == 0
