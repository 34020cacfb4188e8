"""What is read is copied into a folder of ours, and nothing anywhere else."""

import errno
import io
import os

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.options import Upload
from fieldmon.io.sandbox.file_entries import FileEntry
from fieldmon.io.sandbox.unpack import members
from tests.io.sandbox.packed import PLOTS, estate, refused, zipped


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


def test_an_archive_that_lies_about_its_size_is_stopped_at_the_byte(room):
    room.bytes_left = 1000
    packed = zipped({"p.geojson": PLOTS + b" " * 2000})
    assert "brings it to more" in refused(Upload("estate.zip", packed), room)
    assert max(path.stat().st_size for path in room.folder.rglob("*.geojson")) <= 1000


def test_a_full_temporary_folder_is_no_fault_of_the_file(room):
    (room.folder / "001.zip").mkdir()  # no copy can be written there, nor to a full disk
    said = refused(Upload("estate.zip", zipped({"p.geojson": PLOTS})), room)
    assert f"temporary folder {room.folder} takes no copy (Is a directory)" in said

    class Damaged(io.BytesIO):
        def read(self, *_):
            raise OSError(errno.EIO, os.strerror(errno.EIO))

    entry = FileEntry("p.geojson", 10, Damaged)
    with pytest.raises(FileProblem, match=r"^p.geojson cannot be read: Input/output error\.$"):
        room.unpack(entry)
