"""The files that people bring: no links, none that is too large, none that is not there."""

from fieldmon.io.options import Upload
from fieldmon.io.sandbox import limits
from tests.io.sandbox.packed import PLOTS, refused


def test_a_link_in_a_folder_is_not_followed(tmp_path, room):
    folder = tmp_path / "estate"
    folder.mkdir()
    (tmp_path / "secret.geojson").write_bytes(PLOTS)
    (folder / "p.geojson").symlink_to(tmp_path / "secret.geojson")
    assert "nothing of the kind" in refused(folder, room)


def test_a_file_or_folder_that_is_none_is_refused_by_name(tmp_path, room):
    assert "there is none. Check the name" in refused(tmp_path / "gone.zip", room)
    (tmp_path / "empty").mkdir()
    assert "nothing of the kind is in it" in refused(tmp_path / "empty", room)
    limit = limits.size(limits.FILE_BYTES)
    assert limit == "500 MB"


def test_a_file_above_the_limit_is_not_opened(room, monkeypatch):
    monkeypatch.setattr(limits, "FILE_BYTES", 10)
    assert "may have 10 bytes at most" in refused(Upload("p.geojson", PLOTS), room)
