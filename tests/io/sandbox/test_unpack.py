"""From what people bring to one data set in a folder of ours, and nothing anywhere else."""

import io
import stat
import zipfile

import pytest

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.signatures import FileKind
from fieldmon.io.options import Upload
from fieldmon.io.sandbox import limits
from fieldmon.io.sandbox.unpack import Workroom, choose_member, members

PLOTS = b'{"type": "FeatureCollection", "features": []}'
SHP = b"\x00\x00\x27\x0a" + bytes(96)


@pytest.fixture
def room(tmp_path):
    (tmp_path / "room").mkdir()
    return Workroom(tmp_path / "room")


def zipped(contents, compression=zipfile.ZIP_DEFLATED):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", compression) as archive:
        for name, content in contents.items():
            archive.writestr(name, content)
    return data.getvalue()


def estate(**contents):
    return Upload("estate.zip", zipped(contents.pop("files", contents)))


def refused(source, room):
    with pytest.raises(FileProblem) as problem:
        [room.stage(member) for member in members(source, room)]
    return str(problem.value)


def test_parts_of_a_shapefile_belong_together_wherever_they_come_from(tmp_path, room):
    folder = tmp_path / "estate"
    folder.mkdir()
    parts = {f"plots.{end}": SHP if end == "shp" else b"x" for end in ("shp", "dbf", "shx", "prj")}
    for name, data in parts.items():
        (folder / name).write_bytes(data)
    uploads = tuple(Upload(name, data) for name, data in parts.items())
    packed = Upload("estate.zip", zipped({f"in/{name}": data for name, data in parts.items()}))
    for source in (folder / "plots.shp", folder, uploads, packed):
        (member,) = members(source, room)
        assert member.kind is FileKind.SHAPEFILE
        staged = room.stage(member)
        assert {path.name for path in staged.parent.iterdir()} == {
            "data.shp", "data.dbf", "data.shx", "data.prj",
        }  # fmt: skip
        assert staged.read_bytes() == SHP


def test_two_shapefiles_of_one_name_in_two_folders_stay_apart(room):
    packed = zipped({"a/p.shp": SHP, "a/p.dbf": b"A", "b/p.shp": SHP, "b/p.dbf": b"B"})
    found = members(Upload("estate.zip", packed), room)
    tables = {m.name: room.stage(m).with_suffix(".dbf").read_bytes() for m in found}
    assert tables == {"a/p.shp": b"A", "b/p.shp": b"B"}


def test_what_systems_leave_in_folders_is_passed_by(room):
    packed = {
        "p.geojson": PLOTS,
        "__MACOSX/._p.geojson": b"x",
        ".DS_Store": b"x",
        "Thumbs.db": b"x",
    }
    (member,) = members(estate(files=packed), room)
    assert member.name == "p.geojson"


def test_an_archive_in_an_archive_is_looked_into_and_a_third_one_is_not(room):
    inner = zipped({"p.geojson": PLOTS})
    (member,) = members(estate(files={"old.zip": inner}), room)
    assert member.name == "old.zip/p.geojson"
    assert room.stage(member).read_bytes() == PLOTS
    third = zipped({"deep.zip": zipped({"deeper.zip": inner})})
    assert "2 deep inside each other at most" in refused(Upload("estate.zip", third), room)


@pytest.mark.parametrize(
    "name", ["../out.geojson", "a/../../out.geojson", "/etc/out.geojson", "..\\out.geojson",
             "C:\\out.geojson"]
)  # fmt: skip
def test_no_name_from_outside_becomes_a_path(tmp_path, room, name):
    before = {path for path in tmp_path.rglob("*") if not path.is_relative_to(room.folder)}
    source = estate(files={name: PLOTS})
    if ".." in name:
        assert "points outside" in refused(source, room)
    else:
        (member,) = members(source, room)
        assert room.stage(member).is_relative_to(room.folder)
    assert {path for path in tmp_path.rglob("*") if not path.is_relative_to(room.folder)} == before


def test_a_link_in_an_archive_is_refused(room):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        link = zipfile.ZipInfo("p.geojson")
        link.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(link, "/etc/passwd")
    assert "is a link to another file" in refused(Upload("estate.zip", data.getvalue()), room)


def test_a_link_in_a_folder_is_not_followed(tmp_path, room):
    folder = tmp_path / "estate"
    folder.mkdir()
    (tmp_path / "secret.geojson").write_bytes(PLOTS)
    (folder / "p.geojson").symlink_to(tmp_path / "secret.geojson")
    assert "nothing of the kind" in refused(folder, room)


def test_a_locked_archive_says_so(room):
    data = bytearray(zipped({"p.geojson": PLOTS}, zipfile.ZIP_STORED))
    at = data.index(b"PK\x01\x02")
    data[at + 8] |= 1  # the flag in the central directory
    assert "locked with a password" in refused(Upload("estate.zip", bytes(data)), room)


def test_an_archive_that_lies_about_its_size_is_stopped_at_the_byte(room):
    room.bytes_left = 1000
    packed = zipped({"p.geojson": PLOTS + b" " * 2000})
    assert "brings it to more" in refused(Upload("estate.zip", packed), room)
    assert max(path.stat().st_size for path in room.folder.rglob("*.geojson")) <= 1000


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


def test_a_file_or_folder_that_is_none_is_refused_by_name(tmp_path, room):
    assert "there is none. Check the name" in refused(tmp_path / "gone.zip", room)
    (tmp_path / "empty").mkdir()
    assert "nothing of the kind is in it" in refused(tmp_path / "empty", room)
    limit = limits.size(limits.FILE_BYTES)
    assert limit == "500 MB"


def test_a_file_above_the_limit_is_not_opened(room, monkeypatch):
    monkeypatch.setattr(limits, "FILE_BYTES", 10)
    assert "may have 10 bytes at most" in refused(Upload("p.geojson", PLOTS), room)


def test_of_several_the_one_is_taken_that_is_named_and_else_they_are_offered(room):
    files = {"a/p.geojson": PLOTS, "b/p.geojson": PLOTS, "q.geojson": PLOTS}
    found = members(estate(files=files), room)
    assert choose_member(found, "Q.GEOJSON", "estate.zip").name == "q.geojson"
    assert choose_member(found, "a/p.geojson", "estate.zip").name == "a/p.geojson"
    for wanted, words in ((None, "holds 3 files"), ("p.geojson", "none alone is called")):
        with pytest.raises(ChoiceNeeded, match=words) as asked:
            choose_member(found, wanted, "estate.zip")
        assert asked.value.option == "member"
        for choice in asked.value.choices:
            assert choose_member(found, choice, "estate.zip").name == choice
