"""`fieldmon study calibrate`, as a person runs it."""

import pytest

from tests.cli.estate import table


def test_a_search_tells_its_best_and_writes_what_it_tried(run, tmp_path):
    code, out, err, _ = run(
        *["study", "calibrate", "--drawn", 2, "--kept", 1, "--steps", 0, "--seeds", 2]
    )
    assert code == 0, err
    assert "Best joint fit" in out
    assert "Best fit of C alone" in out
    assert len(table(tmp_path / "prior_calibration.csv")) >= 1


def test_a_folder_that_cannot_be_is_said_before_anything_is_searched(run):
    code, _, err, made = run("study", "calibrate", "-o", __file__)
    assert (code, made) == (2, set())
    assert "must be a folder" in err


@pytest.mark.parametrize("study", ["calibrate", "no-prior"])
def test_a_study_of_printed_figures_says_why_it_takes_no_pest(run, study):
    code, _, err, made = run("study", study, "--pest", "whitefly")
    assert (code, made) == (2, set())
    assert f"study {study} goes without --pest" in err
    assert "the thesis's own rule" in err
