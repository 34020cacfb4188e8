"""Zips: the same bytes at any time, and files that who unpacks them may read."""

import io
import zipfile

from fieldmon.io.writers.zipped import zipped, zipped_folder


def test_files_come_back_readable_and_in_their_order():
    with zipfile.ZipFile(io.BytesIO(zipped({"b/two.txt": b"2" * 99, "a.txt": b"1"}))) as archive:
        assert archive.namelist() == ["b/two.txt", "a.txt"]
        assert archive.read("b/two.txt") == b"2" * 99
        assert {info.external_attr >> 16 & 0o777 for info in archive.infolist()} == {0o644}


def test_the_moment_at_which_they_were_written_changes_nothing(tmp_path):
    (tmp_path / "b.txt").write_bytes(b"2")
    (tmp_path / "a.txt").write_bytes(b"1")
    assert zipped_folder(tmp_path) == zipped({"a.txt": b"1", "b.txt": b"2"})
    with zipfile.ZipFile(io.BytesIO(zipped_folder(tmp_path))) as archive:
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
