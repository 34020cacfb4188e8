"""Where studies leave their tables and reports."""

import pytest

from fieldmon.cli.study_output import must_be_folder, write_all
from fieldmon.errors import FileProblem


def test_all_texts_are_written_and_said(tmp_path, capsys):
    write_all(tmp_path, {"a.csv": "x,y\n", "b.html": "שלום"})
    assert (tmp_path / "a.csv").read_bytes() == b"x,y\n"
    assert (tmp_path / "b.html").read_text(encoding="utf-8") == "שלום"
    said = [f"Written: {tmp_path / name}" for name in ("a.csv", "b.html")]
    assert capsys.readouterr().out.splitlines() == said


def test_a_folder_must_be_there(tmp_path):
    must_be_folder(tmp_path)
    with pytest.raises(FileProblem, match="must exist"):
        must_be_folder(tmp_path / "none")
