"""What is read is copied into a folder of ours, and nothing anywhere else."""

import pytest

from fieldmon.io.options import Upload
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
