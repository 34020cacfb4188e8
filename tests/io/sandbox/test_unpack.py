"""From what people bring to its data sets: what belongs together, and which one is meant."""

import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.formats.signatures import FileKind
from fieldmon.io.options import Upload
from fieldmon.io.sandbox.unpack import choose_member, members
from tests.io.sandbox.packed import PLOTS, SHP, estate, zipped


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
