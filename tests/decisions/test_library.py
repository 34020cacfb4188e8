"""Labels read in one call: what the file holds, and what it leaves doubtful as a warning."""

import pytest

import fieldmon as fm


def test_labels_are_read_by_path_and_text_and_refused_as_sentences(tmp_path):
    table = tmp_path / "labels.csv"
    table.write_text("product,waiting_days\nSome oil,7\n")
    assert fm.read_labels(table) == fm.read_labels(str(table))
    assert fm.read_labels(table)[0] == fm.ProductLabel("Some oil", waiting_days=7)
    with pytest.raises(fm.FileProblem, match=r"none\.csv must be readable"):
        fm.read_labels(tmp_path / "none.csv")
    with pytest.raises(fm.SettingError, match="given by its path"):
        fm.read_labels(3)
