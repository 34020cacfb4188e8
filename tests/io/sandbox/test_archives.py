"""What lies in archives is looked into, and what no honest one does refused."""

import io
import stat
import zipfile

from fieldmon.io.options import Upload
from fieldmon.io.sandbox import limits
from fieldmon.io.sandbox.unpack import members
from tests.io.sandbox.packed import PLOTS, estate, refused, zipped


def test_an_archive_in_an_archive_is_looked_into_and_a_third_one_is_not(room):
    inner = zipped({"p.geojson": PLOTS})
    (member,) = members(estate(files={"old.zip": inner}), room)
    assert member.name == "old.zip/p.geojson"
    assert room.stage(member).read_bytes() == PLOTS
    third = zipped({"deep.zip": zipped({"deeper.zip": inner})})
    assert "2 deep inside each other at most" in refused(Upload("estate.zip", third), room)


def test_a_link_in_an_archive_is_refused(room):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        link = zipfile.ZipInfo("p.geojson")
        link.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(link, "/etc/passwd")
    assert "is a link to another file" in refused(Upload("estate.zip", data.getvalue()), room)


def test_a_locked_archive_says_so(room):
    data = bytearray(zipped({"p.geojson": PLOTS}, zipfile.ZIP_STORED))
    at = data.index(b"PK\x01\x02")
    data[at + 8] |= 1  # the flag in the central directory
    assert "locked with a password" in refused(Upload("estate.zip", bytes(data)), room)


def test_what_no_honest_archive_does_is_refused_before_unpacking(room, monkeypatch):
    monkeypatch.setattr(limits, "ARCHIVE_ENTRIES", 3)
    monkeypatch.setattr(limits, "UNPACKED_BYTES", 50_000)
    monkeypatch.setattr(limits, "RATIO_FROM_BYTES", 10_000)
    many = {f"{k}.geojson": PLOTS for k in range(4)}
    assert "3 files at most, but estate.zip holds 4" in refused(estate(files=many), room)
    assert "unpack to 50 kB at most" in refused(estate(files={"p.csv": b" " * 60_000}), room)
    assert "100 times its size at most" in refused(estate(files={"p.csv": b" " * 40_000}), room)
    assert [path for path in room.folder.rglob("*") if path.suffix == ".csv"] == []


def test_a_damaged_archive_ends_in_a_sentence_at_every_cut(room):
    whole = zipped({"p.geojson": PLOTS * 20, "q.csv": b"lon,lat\n1,2\n" * 50})
    for cut in range(4, len(whole), 7):
        assert len(refused(Upload("estate.zip", whole[:cut]), room)) > 20


def test_what_systems_leave_in_folders_is_passed_by(room):
    packed = {
        "p.geojson": PLOTS,
        "__MACOSX/._p.geojson": b"x",
        ".DS_Store": b"x",
        "Thumbs.db": b"x",
    }
    (member,) = members(estate(files=packed), room)
    assert member.name == "p.geojson"
